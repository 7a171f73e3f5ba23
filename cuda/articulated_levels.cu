// Instantiates the pairwise tree's levels for articulated handles.
#include "cuda/space/device_levels.cuh"

namespace catena::cuda {

std::unique_ptr<dca::LevelPart> make_articulated_levels(ChainGroup const& group,
                                                        dca::LevelWork const& work) {
    return dca::with_articulated_leaf(group, MakeLevels{group, work});
}

}  // namespace catena::cuda
