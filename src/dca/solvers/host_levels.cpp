// Parts of the level solver that are computed on the host (level_solver.hpp).
#include "dca/leaf_choice.hpp"
#include "dca/space_levels.hpp"

namespace catena::dca {

LevelPartMaker host_levels(Executor const& executor) {
    return [&executor](ChainGroup const& group, LevelWork const& work) {
        auto const make = [&](auto leaf) -> std::unique_ptr<LevelPart> {
            using Leaf = typename decltype(leaf)::type;
            return std::make_unique<SpaceLevels<Leaf, HostSpace, HostCrossing>>(
                group, work, HostSpace(executor));
        };
        if (group.handles == Handles::articulated) return with_articulated_leaf(group, make);
        return group.beads || group.axes == Axes::world ? with_absolute_leaf(group, make)
                                                        : with_joint_leaf(group, make);
    };
}

}  // namespace catena::dca
