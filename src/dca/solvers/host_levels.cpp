// Parts of the level solver that are computed on the host (level_solver.hpp), except those of
// floating handles in joint coordinates.
#include "dca/solvers/host_levels.hpp"

namespace catena::dca {

LevelPartMaker host_levels(Executor const& executor) {
    return [&executor](ChainGroup const& group, LevelWork const& work) {
        MakeHostPart const make{group, work, executor};
        if (group.handles == Handles::articulated) return with_articulated_leaf(group, make);
        return group.beads || group.axes == Axes::world ? with_absolute_leaf(group, make)
                                                        : make_joint_part(make);
    };
}

}  // namespace catena::dca
