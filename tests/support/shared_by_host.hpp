// What FrontierExchange asks of a space whose ranks reach each other's memory, by a communicator:
// for spaces that run the GPU's kernels.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "mpi/communicator.hpp"
#include "tree/tree.hpp"

namespace catena::test {

class SharedByHost {
  public:
    SharedByHost() = default;
    /// `communicator`: null for no way.
    SharedByHost(Communicator const* communicator, dca::Schedule const& schedule, int width) {
        if (!communicator || schedule.shared.empty()) return;
        communicator_ = communicator;
        numbers_.resize(static_cast<std::size_t>(communicator->size()), 0);
        for (dca::FrontierUnit const& unit : schedule.shared)
            numbers_[static_cast<std::size_t>(unit.owner)] += width;
    }
    explicit operator bool() const { return communicator_ != nullptr; }
    Communicator const* communicator() const { return communicator_; }
    /// Of one rank to all.
    template <class Numbers>
    void operator()(Numbers const& numbers) const {
        std::vector<double> own(
            static_cast<std::size_t>(numbers_[static_cast<std::size_t>(communicator_->rank())]));
        for (std::size_t i = 0; i < own.size(); ++i)
            own[i] = numbers.show(static_cast<std::int64_t>(i));
        std::vector<double> all(static_cast<std::size_t>(
            std::accumulate(numbers_.begin(), numbers_.end(), std::int64_t{0})));
        std::vector<std::int64_t> bytes = numbers_;
        for (std::int64_t& of_rank : bytes) of_rank *= static_cast<std::int64_t>(sizeof(double));
        communicator_->all_gather(std::as_bytes(std::span(own)),
                                  std::as_writable_bytes(std::span(all)), bytes);
        for (std::size_t i = 0; i < all.size(); ++i)
            numbers.take(static_cast<std::int64_t>(i), all[i]);
    }

  private:
    Communicator const* communicator_ = nullptr;
    std::vector<std::int64_t> numbers_;  // of each rank
};

}  // namespace catena::test
