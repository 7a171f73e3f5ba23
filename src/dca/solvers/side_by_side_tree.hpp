// Fused sweeps of which some runs and merges are processed side by side in vectors.
#pragma once

#include <vector>

#include "dca/simd/side_by_side.hpp"

namespace catena::dca {

/// The tree of a group's chains, divided: runs and merges that are processed side by side, and the
/// trees of all others, level after level.
template <class Leaf, class Space>
class SideBySideTree {
    using Tree = typename Space::Tree;

  public:
    /// Divides the tree. `model` is the group's view; the group must outlive this object.
    SideBySideTree(ChainGroup const& group, GroupView const& model, SimdLevel level)
        : aside_(group, model, level) {
        if (!empty()) lay_out_rest(group);
    }
    // Trees point to lists of this object.
    SideBySideTree(SideBySideTree const&) = delete;
    SideBySideTree& operator=(SideBySideTree const&) = delete;

    /// True if no runs are processed side by side; then no sweep may be executed.
    bool empty() const { return aside_.items() == 0; }
    /// Returns the memory in bytes.
    std::int64_t bytes() const { return aside_.bytes(); }

    /// Executes a fused sweep. The others of each level follow those that are processed side by
    /// side. close(roots) executes both passes over the tree of the roots. Completes `work`.
    template <class Sweep, class Close>
    void execute(Space const& space, RunWork<Leaf>& work, Sweep const& sweep, Close const& close) {
        std::size_t const levels = aside_.levels().size();
        aside_.climb(space, work);
        space.climb(rest_.front(), sweep);
        for (std::size_t l = 0; l < levels; ++l) {
            aside_.climb_level(space, work.sweeps, l);
            space.climb(rest_[1 + l], sweep);
        }
        close(rest_.back());
        for (std::size_t l = levels; l-- > 0;) {
            aside_.descend_level(space, work.sweeps, l);
            space.descend(rest_[1 + l], sweep);
        }
        space.descend(rest_.front(), sweep);
        aside_.descend(space, work);
    }

  private:
    /// Builds the trees of everything that is not processed side by side: runs, one level after the
    /// other, and the roots.
    void lay_out_rest(ChainGroup const& group) {
        auto const add = [&](auto const& runs, auto const& levels, auto const& roots) {
            rest_.emplace_back(runs, levels, roots, group.schedule.slots, group.joints.restricted,
                               SweepsOf<Leaf>::Sweeps::in_stage);
        };
        add(aside_.other_runs(), no_levels_, no_roots_);
        for (LevelDealtOut const& level : aside_.levels()) add(no_runs_, level.others, no_roots_);
        add(no_runs_, no_levels_, group.schedule.roots);
    }

    SideBySide<Leaf> aside_;
    // Empty lists for trees without runs, merges or roots.
    std::vector<Run> no_runs_;
    std::vector<std::vector<Merge>> no_levels_;
    std::vector<Root> no_roots_;
    // Trees of everything that is not processed side by side, see lay_out_rest().
    std::vector<Tree> rest_;
};

}  // namespace catena::dca
