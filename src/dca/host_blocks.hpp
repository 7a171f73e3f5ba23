// Blocks of whole chains on the host: one thread executes everything that a time step does with a
// block.
#pragma once

#include <vector>

#include "dca/solver.hpp"
#include "dca/tree_sweeps.hpp"
#include "tree/stages.hpp"

namespace catena {

/// The blocks of a group, one chain per block.
class HostBlocks {
  public:
    /// Makes the blocks. Precondition: the group shares no chain with other ranks.
    explicit HostBlocks(ChainGroup const& group)
        : schedule_(group.schedule),
          plan_(dca::plan_blocks(group.schedule, last_bodies(group.ends.tips))) {
        for (auto const& level : schedule_.levels)
            merges_.insert(merges_.end(), level.begin(), level.end());
    }
    std::int64_t count() const { return plan_.blocks(); }

  private:
    friend class HostBlock;
    dca::Schedule const& schedule_;
    dca::BlockPlan plan_;
    std::vector<dca::Merge> merges_;  // Merges of all levels, one level after the other.
};

/// One block: loops over its bodies and tips, and sweeps over its chains.
class HostBlock {
  public:
    HostBlock(HostBlocks const& blocks, std::int64_t at)
        : blocks_(blocks), at_(static_cast<std::size_t>(at)) {}

    /// Calls action(k) for every body of the block.
    template <class Action>
    void each_body(Action const& action) const {
        each(blocks_.plan_.body[at_], action);
    }
    /// Calls action(i) for every tip of the block.
    template <class Action>
    void each_tip(Action const& action) const {
        each(blocks_.plan_.tip[at_], action);
    }
    /// Inward pass of a sweep (tree_sweeps.hpp) over the block's chains.
    template <class Sweep>
    void climb(Sweep const& sweep) const {
        each(plan().run[at_], [&](std::int64_t i) {
            climb_run(sweep, blocks_.schedule_.runs[static_cast<std::size_t>(i)]);
        });
        for (int l = 0; l < plan().levels; ++l)
            each_merge(l, [&](dca::Merge const& m) { climb_merge(sweep, m); });
        each(plan().root[at_], [&](std::int64_t i) {
            close_root(sweep, blocks_.schedule_.roots[static_cast<std::size_t>(i)]);
        });
    }
    /// Inward and outward pass of a sweep over the block's chains.
    template <class Sweep>
    void climb_and_descend(Sweep const& sweep) const {
        climb(sweep);
        for (int l = plan().levels; l-- > 0;)
            each_merge(l,
                       [&](dca::Merge const& m) { descend_merge(sweep, m, sweep.node(m.joint)); });
        each(plan().run[at_], [&](std::int64_t i) {
            descend_run(sweep, blocks_.schedule_.runs[static_cast<std::size_t>(i)]);
        });
    }

  private:
    dca::BlockPlan const& plan() const { return blocks_.plan_; }
    template <class Action>
    void each_merge(int level, Action const& action) const {
        dca::Range const range = plan().merge[at_ * static_cast<std::size_t>(plan().levels) +
                                              static_cast<std::size_t>(level)];
        each(range, [&](std::int64_t i) { action(blocks_.merges_[static_cast<std::size_t>(i)]); });
    }
    template <class Action>
    static void each(dca::Range const& range, Action const& action) {
        for (std::int64_t i = range.begin; i < range.end; ++i) action(i);
    }
    HostBlocks const& blocks_;
    std::size_t at_;
};

}  // namespace catena
