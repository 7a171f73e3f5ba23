// Instantiates the pairwise tree's levels for handles in joint frames.
#include "cuda/space/device_levels.cuh"

namespace catena::cuda {

std::unique_ptr<dca::LevelPart> make_joint_levels(ChainGroup const& group,
                                                  dca::LevelWork const& work) {
    return dca::with_joint_leaf(group, MakeLevels{group, work});
}

}  // namespace catena::cuda
