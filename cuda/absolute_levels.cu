// Instantiates the pairwise tree's levels for beads and for bodies whose forces are kept in ground
// axes.
#include "cuda/device/gpu.hpp"
#include "cuda/space/device_levels.cuh"

namespace catena::cuda {

std::unique_ptr<dca::LevelPart> make_absolute_levels(ChainGroup const& group,
                                                     dca::LevelWork const& work) {
    return dca::with_absolute_leaf(group, MakeLevels{group, work});
}

std::unique_ptr<dca::LevelPart> make_levels(ChainGroup const& group, dca::LevelWork const& work) {
    if (group.handles == Handles::articulated) return make_articulated_levels(group, work);
    return group.beads || group.axes == Axes::world ? make_absolute_levels(group, work)
                                                    : make_joint_levels(group, work);
}

}  // namespace catena::cuda
