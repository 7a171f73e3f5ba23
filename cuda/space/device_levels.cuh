// Construction of the pairwise tree's levels on a device; each kind of handles is compiled in a
// file of its own.
#pragma once

#include "cuda/space/device_crossing.cuh"
#include "dca/leaf_choice.hpp"
#include "dca/space_levels.hpp"

namespace catena::cuda {

std::unique_ptr<dca::LevelPart> make_absolute_levels(ChainGroup const&, dca::LevelWork const&);
std::unique_ptr<dca::LevelPart> make_articulated_levels(ChainGroup const&, dca::LevelWork const&);
std::unique_ptr<dca::LevelPart> make_joint_levels(ChainGroup const&, dca::LevelWork const&);

/// Makes the levels for a leaf type; used with with_absolute_leaf() and its siblings.
struct MakeLevels {
    ChainGroup const& group;
    dca::LevelWork const& work;
    template <class Leaf>
    std::unique_ptr<dca::LevelPart> operator()(dca::Of<Leaf>) const {
        return std::make_unique<dca::SpaceLevels<Leaf, DeviceSpace, DeviceCrossing>>(
            group, work, DeviceSpace(this_thread()));
    }
};

}  // namespace catena::cuda
