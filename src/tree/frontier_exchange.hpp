// What ranks show each other of the units of chains that several of them share.
#pragma once

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <vector>

#include "mpi/communicator.hpp"
#include "tree/frontier_records.hpp"

namespace catena::dca {

/// Loops over numbers that pass through the host's memory.
template <class Numbers>
struct PublishNumbers {
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

/// Brings `width` numbers of every rank's own units to all ranks: show(), then bring(), both with
/// the same Numbers of that width. Straight from one GPU's memory to another's where the space can
/// (Space::connect), else by a collective. Bodies' numbers for neighbours, `beside` of them at
/// most, may go along (BodyExchange): they are ready when show() is.
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
    /// Whether ranks show each other anything, and by their hosts.
    bool asks_host() const { return !shared_.empty() && !direct_; }
    bool is_direct() const { return static_cast<bool>(direct_); }
    FrontierUnit const* own_units() const { return own_units_.data(); }
    /// In the schedule's order.
    FrontierUnit const* units() const { return units_.data(); }

    template <class Numbers>
    void show(Space const& space, Numbers const& numbers) {
        if (!direct_)
            space.for_each(width_ * std::ssize(own_list_),
                           PublishNumbers<Numbers>{numbers, own_.data()});
    }
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
    /// Both, with a sweep's way up `tree` before and its way down after them, and up and down the
    /// `top` in between, if the space does all that in one; else nothing is done. Ranks that do and
    /// ranks that do not find together. `sweep` may be a ScanThen.
    template <class Numbers, class Tree, class Sweep, class... Beside>
    bool turn(Space const& space, Communicator const& communicator, Numbers const& numbers,
              Tree const& tree, Tree const& top, Sweep const& sweep, Beside const&... beside) {
        if (!direct_ || !space.turn_shared(direct_, numbers, tree, top, sweep, beside...))
            return false;
        communicator.tally(message_with(beside...));
        return true;
    }

  private:
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
