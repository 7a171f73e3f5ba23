// Order of the launches of a scan over its stages, independent of how a launch is made (see
// stage_walk.cuh for sweeps).
#pragma once

#include <cstddef>

#include "cuda/sweeps/frontier_launch.hpp"
#include "cuda/sweeps/scan_kernels.cuh"

namespace catena::cuda {

/// Performs the passes of a scan by calls of `Launches`, which has these members.
/// - stages(), blocks(i): number of stages and blocks of stage i.
/// - climb(i, scan), both_passes(i, scan), descend(i, scan): inward pass, both passes and outward
/// pass of stage i.
/// - shared_passes(scan, exchange, top): both passes of the last stage with an exchange between
/// ranks and their `top` tree.
template <class Launches>
class ScanWalk {
  public:
    explicit ScanWalk(Launches const& launches) : launches_(launches) {}
    /// Performs the inward pass.
    template <class Scan>
    void climb(Scan const& scan) const {
        climb_below(launches_.stages(), scan);
    }
    /// Performs the outward pass.
    template <class Scan>
    void descend(Scan const& scan) const {
        descend_below(launches_.stages(), scan);
    }
    /// Performs both passes.
    template <class Scan>
    void climb_and_descend(Scan const& scan) const {
        if (launches_.stages() == 0) return;
        std::size_t const last = launches_.stages() - 1;
        climb_below(last, scan);
        launches_.both_passes(last, scan);
        descend_below(last, scan);
    }
    /// Performs both passes with an exchange between ranks and their `top` tree, as
    /// StageWalk::shared_passes().
    template <class Scan, class Exchange>
    bool shared_passes(Scan const& scan, Exchange const& exchange, Launches const& top) const {
        if (!turns_in_a_block(launches_, top)) return false;
        std::size_t const last = launches_.stages() - 1;
        climb_below(last, scan);
        launches_.shared_passes(scan, exchange, top);
        descend_below(last, scan);
        return true;
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
