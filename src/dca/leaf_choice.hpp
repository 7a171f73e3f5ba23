// Selection of the Leaf type for a group's bodies. Each function calls use(Of<Leaf>{}) and returns
// its result.
#pragma once

#include "dca/articulated_sweeps.hpp"
#include "dca/body_leaf.hpp"
#include "math/with_number.hpp"

namespace catena::dca {

/// Tag that passes a type as a value.
template <class T>
struct Of {
    using type = T;
};

/// Selects the leaf for beads, and for bodies in absolute coordinates on links or spherical joints.
template <class Use>
auto with_absolute_leaf(ChainGroup const& group, Use const& use) {
    if (group.beads) return group.directions == 1 ? use(Of<BeadLeaf<1>>{}) : use(Of<BeadLeaf<3>>{});
    if (group.linked)
        return group.directions == 1 ? use(Of<BodyLeaf<1, LinkFrames<1>>>{})
                                     : use(Of<BodyLeaf<3, LinkFrames<3>>>{});
    return group.directions == 3 ? use(Of<BodyLeaf<3, GroundFrames<3>>>{})
                                 : use(Of<BodyLeaf<6, GroundFrames<6>>>{});
}

/// Selects the leaf with articulated handles, for bodies in joint coordinates.
template <class Use>
auto with_articulated_leaf(ChainGroup const& group, Use const& use) {
    return group.joints.has_screws ? use(Of<ArticulatedLeaf<true>>{})
                                   : use(Of<ArticulatedLeaf<false>>{});
}

/// Selects the leaf with floating handles, for bodies in joint coordinates.
template <class Use>
auto with_joint_leaf(ChainGroup const& group, Use const& use) {
    return with_number<2, 6>(group.directions, [&](auto directions) {
        constexpr int K = decltype(directions)::value;
        if constexpr (K >= 5)  // Handles of joints that translate carry five directions or six.
            if (group.joints.has_screws) return use(Of<BodyLeaf<K, JointFrameHandles<K, true>>>{});
        return use(Of<BodyLeaf<K, JointFrameHandles<K, false>>>{});
    });
}

}  // namespace catena::dca
