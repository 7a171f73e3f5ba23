// Which launches a scan takes over its stages, whoever makes them: as stage_walk.cuh for sweeps.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cuda/sweeps/frontier_launch.hpp"
#include "cuda/sweeps/scan_kernels.cuh"

namespace catena::cuda {

/// `Launches`: stages() and blocks(i) of stage i; climb(i, scan), turn(i, scan) and descend(i,
/// scan) of it; whether turn_then(scan, count, action) was launched; turn_shared(scan, exchange,
/// top) of the last stage, what ranks show each other and `top`, and whether turn_shared_then(scan,
/// exchange, top, count, action) was launched.
template <class Launches>
class ScanWalk {
  public:
    explicit ScanWalk(Launches const& launches) : launches_(launches) {}
    template <class Scan>
    void climb(Scan const& scan) const {
        climb_below(launches_.stages(), scan);
    }
    template <class Scan>
    void descend(Scan const& scan) const {
        descend_below(launches_.stages(), scan);
    }
    template <class Scan>
    void climb_and_descend(Scan const& scan) const {
        if (launches_.stages() == 0) return;
        std::size_t const last = launches_.stages() - 1;
        climb_below(last, scan);
        launches_.turn(last, scan);
        descend_below(last, scan);
    }
    /// And then action(k) for k < count, if one launch does all; else nothing is done.
    template <class Scan, class Action>
    bool at_once(Scan const& scan, std::int64_t count, Action const& action) const {
        return is_one_block() && launches_.turn_then(scan, count, action);
    }
    bool is_one_block() const { return launches_.stages() == 1 && launches_.blocks(0) == 1; }

    /// As StageWalk::turn_shared.
    template <class Scan, class Exchange>
    bool turn_shared(Scan const& scan, Exchange const& exchange, Launches const& top) const {
        if (!turns_in_a_block(launches_, top)) return false;
        std::size_t const last = launches_.stages() - 1;
        climb_below(last, scan);
        launches_.turn_shared(scan, exchange, top);
        descend_below(last, scan);
        return true;
    }
    /// And at_once().
    template <class Scan, class Exchange, class Action>
    bool turn_shared(Scan const& scan, Exchange const& exchange, Launches const& top,
                     std::int64_t count, Action const& action) const {
        return is_one_block() && turns_in_a_block(launches_, top) &&
               launches_.turn_shared_then(scan, exchange, top, count, action);
    }

  private:
    template <class Scan>
    void climb_below(std::size_t stages, Scan const& scan) const {
        for (std::size_t i = 0; i < stages; ++i) launches_.climb(i, scan);
    }
    template <class Scan>
    void descend_below(std::size_t stages, Scan const& scan) const {
        for (std::size_t i = stages; i-- > 0;) launches_.descend(i, scan);
    }
    Launches launches_;
};

}  // namespace catena::cuda
