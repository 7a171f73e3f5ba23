// What ranks show each other of the units of chains that several of them share.
#pragma once

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <vector>

#include "dca/records.hpp"
#include "dca/tree.hpp"
#include "mpi/communicator.hpp"

namespace catena::dca {

/// Numbers of records: number i is i % width of unit i / width, of this rank's units or of all.
template <class T>
struct RecordNumbers {
    static constexpr int width = RecordsView<T, Order::plain>::numbers;
    RecordsView<T, Order::plain> records;
    SharedUnit const *own, *all;
    CATENA_HD double show(std::int64_t i) const { return records.number(own[i / width].slot, static_cast<int>(i % width)); }
    CATENA_HD void take(std::int64_t i, double value) const { records.number(all[i / width].slot, static_cast<int>(i % width)) = value; }
};

/// As RecordNumbers, of two records a unit: those of the one, then those of the other.
template <class A, class B>
struct NumbersOfBoth {
    static constexpr int of_first = RecordNumbers<A>::width, width = of_first + RecordNumbers<B>::width;
    RecordsView<A, Order::plain> first;
    RecordsView<B, Order::plain> second;
    SharedUnit const *own, *all;
    CATENA_HD double show(std::int64_t i) const { return number(own[i / width].slot, static_cast<int>(i % width)); }
    CATENA_HD void take(std::int64_t i, double value) const { number(all[i / width].slot, static_cast<int>(i % width)) = value; }

  private:
    CATENA_HD double& number(std::int64_t slot, int n) const {
        return n < of_first ? first.number(slot, n) : second.number(slot, n - of_first);
    }
};

/// Loops over numbers that pass through the host's memory.
template <class Numbers>
struct ShowNumbers {
    Numbers numbers;
    double* out;
    CATENA_HD void operator()(std::int64_t i) const { out[i] = numbers.show(i); }
};
template <class Numbers>
struct TakeNumbers {
    Numbers numbers;
    double const* in;
    CATENA_HD void operator()(std::int64_t i) const { numbers.take(i, in[i]); }
};

/// Brings `width` numbers of every rank's own units to all ranks: show(), then bring(), both with the same Numbers of that width. Straight
/// from one GPU's memory to another's where the space can (Space::connect), else by a collective. Bodies' numbers for neighbours, `beside`
/// of them at most, may go along (BodyExchange): they are ready when show() is.
template <class Space>
class SharedUnits {
  public:
    SharedUnits(Schedule const& schedule, int width, Space const& space, Communicator const& communicator, int beside = 0)
        : shared_(schedule.shared),
          own_list_(own_units(schedule)),
          own_units_(own_list_),
          units_(shared_),
          width_(width),
          direct_(space.connect(schedule, width, beside)),
          own_(own_list_.size() * static_cast<std::size_t>(width)),
          all_(shared_.size() * static_cast<std::size_t>(width)),
          bytes_(static_cast<std::size_t>(communicator.size()), 0) {
        for (SharedUnit const& unit : shared_)
            bytes_[static_cast<std::size_t>(unit.owner)] += width * static_cast<std::int64_t>(sizeof(double));
    }
    /// Whether ranks show each other anything, and by their hosts.
    bool asks_host() const { return !shared_.empty() && !direct_; }
    bool is_direct() const { return static_cast<bool>(direct_); }
    SharedUnit const* own_units() const { return own_units_.data(); }
    /// In the schedule's order.
    SharedUnit const* units() const { return units_.data(); }

    template <class Numbers>
    void show(Space const& space, Numbers const& numbers) {
        if (!direct_) space.for_each(width_ * std::ssize(own_list_), ShowNumbers<Numbers>{numbers, own_.data()});
    }
    template <class Numbers, class... Beside>
    void bring(Space const& space, Communicator const& communicator, Numbers const& numbers, Beside const&... beside) {
        if (direct_) {
            Traffic message;
            message.gathers = 1;
            message.gathered_bytes = std::accumulate(bytes_.begin(), bytes_.end(), std::int64_t{0});
            ((message += traffic_of(beside)), ...);
            communicator.tally(message);
            return space.exchange(direct_, numbers, beside...);
        }
        (space.exchange(communicator, beside), ...);
        space.wait();
        communicator.all_gather(std::as_bytes(std::span(own_.data(), own_list_.size() * static_cast<std::size_t>(width_))),
                                std::as_writable_bytes(std::span(all_.data(), shared_.size() * static_cast<std::size_t>(width_))), bytes_);
        space.for_each(width_ * std::ssize(shared_), TakeNumbers<Numbers>{numbers, all_.data()});
    }

  private:
    static std::vector<SharedUnit> own_units(Schedule const& schedule) {
        std::vector<SharedUnit> own;
        std::copy_if(schedule.shared.begin(), schedule.shared.end(), std::back_inserter(own), [](auto const& u) { return u.is_own; });
        return own;
    }

    std::vector<SharedUnit> const& shared_;
    std::vector<SharedUnit> own_list_;
    typename Space::template List<SharedUnit> own_units_, units_;
    int width_;
    typename Space::Direct direct_;
    typename Space::template HostArray<double> own_, all_;
    std::vector<std::int64_t> bytes_;
};

}  // namespace catena::dca
