// Trees of a HostSpace: the items of sweeps and scans, as they lie in the group's schedule.
#pragma once

#include <span>
#include <vector>

#include "tree/stages.hpp"
#include "tree/tree.hpp"

namespace catena {

/// The items of a tree: runs, merges level by level, and roots. The items of one level are
/// independent of each other and are computed before the next level.
class HostTree {
  public:
    HostTree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels,
             std::vector<dca::Root> const& roots, std::int64_t /*slots*/,
             std::span<std::uint8_t const> /*restricted*/, dca::StageRecords const& /*records*/)
        : runs_(runs), levels_(levels), roots_(roots) {}

  private:
    friend class HostSpace;
    std::span<dca::Run const> runs_;
    std::span<std::vector<dca::Merge> const> levels_;
    std::span<dca::Root const> roots_;
};

/// The tree of a scan along the chains.
///
/// of_run(run) is the value of a run; joined(inboard, outboard) combines the values of two
/// neighbours. whole(), set_whole(), before() and set_before() are indexed by slot.
///
/// After climb(), whole() is defined for complete nodes: roots, and what other ranks need. It
/// stays valid until descend(). descend() reads before() in these slots and writes it in the
/// slots of the runs, or of the inputs of the lowest level. Other slots are unspecified.
class HostScanTree {
  public:
    HostScanTree(std::vector<dca::Run> const& runs,
                 std::vector<std::vector<dca::Merge>> const& levels,
                 std::vector<dca::Root> const& /*roots*/, std::int64_t /*slots*/)
        : runs_(runs), levels_(levels) {}

  private:
    friend class HostSpace;
    std::span<dca::Run const> runs_;
    std::span<std::vector<dca::Merge> const> levels_;
};

}  // namespace catena
