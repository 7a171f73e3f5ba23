// Exchange between ranks of the frontier: the units of chains that several ranks share.
#pragma once

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <vector>

#include "mpi/communicator.hpp"
#include "tree/frontier_records.hpp"

namespace catena::dca {

/// Loop body that copies numbers of own units to a buffer in host memory.
template <class Numbers>
struct PublishNumbers {
    Numbers numbers;
    double* out;
    CATENA_HD void operator()(std::int64_t i) const { out[i] = numbers.show(i); }
};
/// Loop body that copies numbers of all units from a buffer in host memory.
template <class Numbers>
struct TakeNumbers {
    Numbers numbers;
    double const* in;
    CATENA_HD void operator()(std::int64_t i) const { numbers.take(i, in[i]); }
};

/// Exchanges `width` numbers of every shared unit, so that all ranks have those of all units. Call
/// show(), then bring(), with the same Numbers. The exchange is direct from GPU memory to GPU
/// memory if the space supports that (Space::connect), else an all-gather through host memory. Up
/// to `beside` numbers of bodies for neighbouring ranks may be exchanged together with them
/// (BodyExchange). They must be ready when show() is called.
template <class Space>
class FrontierExchange {
  public:
    FrontierExchange(Schedule const& schedule, int width, Space const& space,
                     Communicator const& communicator, int beside = 0)
        : shared_(schedule.shared),
          own_list_(own_units(schedule)),
          own_units_(own_list_),
          units_(shared_),
          width_(width),
          direct_(space.connect(schedule, width, beside)),
          own_(own_list_.size() * static_cast<std::size_t>(width)),
          all_(shared_.size() * static_cast<std::size_t>(width)),
          bytes_(static_cast<std::size_t>(communicator.size()), 0) {
        for (FrontierUnit const& unit : shared_)
            bytes_[static_cast<std::size_t>(unit.owner)] +=
                width * static_cast<std::int64_t>(sizeof(double));
    }
    /// True if the ranks exchange units through host memory.
    bool asks_host() const { return !shared_.empty() && !direct_; }
    bool is_direct() const { return static_cast<bool>(direct_); }
    /// Units that this rank owns, in the memory of the space.
    FrontierUnit const* own_units() const { return own_units_.data(); }
    /// Units of all ranks in the schedule's order, in the memory of the space.
    FrontierUnit const* units() const { return units_.data(); }

    /// Publishes the numbers of own units; on the direct path this is left to bring().
    template <class Numbers>
    void show(Space const& space, Numbers const& numbers) {
        if (!direct_)
            space.for_each(width_ * std::ssize(own_list_),
                           PublishNumbers<Numbers>{numbers, own_.data()});
    }
    /// Completes the exchange. Collective.
    template <class Numbers, class... Beside>
    void bring(Space const& space, Communicator const& communicator, Numbers const& numbers,
               Beside const&... beside) {
        if (direct_) {
            communicator.tally(message_with(beside...));
            return space.exchange(direct_, numbers, beside...);
        }
        (space.exchange(communicator, beside), ...);
        space.wait();
        communicator.all_gather(
            std::as_bytes(
                std::span(own_.data(), own_list_.size() * static_cast<std::size_t>(width_))),
            std::as_writable_bytes(
                std::span(all_.data(), shared_.size() * static_cast<std::size_t>(width_))),
            bytes_);
        space.for_each(width_ * std::ssize(shared_), TakeNumbers<Numbers>{numbers, all_.data()});
    }
    /// Exchanges in one fused operation: the inward pass over `tree`, show() and bring(), both
    /// passes over `top`, and the outward pass over `tree`. `sweep` defines the passes. Returns
    /// false and does nothing if the space cannot fuse them. Ranks that fuse and ranks that do not
    /// can exchange with each other. Collective.
    template <class Numbers, class Tree, class Sweep, class... Beside>
    bool both_passes(Space const& space, Communicator const& communicator, Numbers const& numbers,
                     Tree const& tree, Tree const& top, Sweep const& sweep,
                     Beside const&... beside) {
        if (!direct_ || !space.shared_passes(direct_, numbers, tree, top, sweep, beside...))
            return false;
        communicator.tally(message_with(beside...));
        return true;
    }

  private:
    /// Traffic of one exchange: the all-gather and the numbers exchanged together with it.
    template <class... Beside>
    Traffic message_with(Beside const&... beside) const {
        Traffic message;
        message.gathers = 1;
        message.gathered_bytes = std::accumulate(bytes_.begin(), bytes_.end(), std::int64_t{0});
        ((message += traffic_of(beside)), ...);
        return message;
    }
    static std::vector<FrontierUnit> own_units(Schedule const& schedule) {
        std::vector<FrontierUnit> own;
        std::copy_if(schedule.shared.begin(), schedule.shared.end(), std::back_inserter(own),
                     [](auto const& u) { return u.is_own; });
        return own;
    }

    std::vector<FrontierUnit> const& shared_;
    std::vector<FrontierUnit> own_list_;
    typename Space::template List<FrontierUnit> own_units_, units_;
    int width_;
    typename Space::Direct direct_;
    typename Space::template HostArray<double> own_, all_;
    std::vector<std::int64_t> bytes_;
};

}  // namespace catena::dca
