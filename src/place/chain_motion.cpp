// Implements translations and rotations of whole chains.
#include "place/chain_motion.hpp"

#include <vector>

namespace catena::scene {

void translate(ChainSpec& chain, Vec3 const& by) {
    if (chain.tip_joint.anchor) chain.tip_joint.anchor = *chain.tip_joint.anchor + by;
    for (LoopClosure& loop : chain.loops) {
        if (loop.inboard == LoopClosure::ground)
            loop.joint.translation = loop.joint.translation + by;
        if (loop.outboard != LoopClosure::ground) continue;
        loop.end_translation = loop.end_translation + by;
        if (loop.joint.anchor) loop.joint.anchor = *loop.joint.anchor + by;
    }
    for (Vec3& position : chain.beads.position) position = position + by;
    for (Vec3& position : chain.linked.position) position = position + by;
    bool const fixed = chain.base == Base::fixed;
    if (chain.is_beads()) {
        if (fixed) chain.beads.anchor = chain.beads.anchor + by;
    } else if (chain.is_linked()) {
        if (fixed) chain.linked.anchor = chain.linked.anchor + by;
    } else {
        Vec3& place = fixed ? chain.bodies.translation[0] : chain.bodies.free_base.position;
        place = place + by;
    }
}

bool is_rotatable(ChainSpec const& chain) {
    bool const attached =
        chain.base == Base::fixed || (chain.tip == Tip::jointed && !chain.tip_joint.ring);
    return !attached && (chain.is_beads() || chain.is_linked());
}

void rotate(ChainSpec& chain, Quat const& rotation, Vec3 const& about) {
    Mat3 const r = to_matrix(rotation);
    auto const turn = [&](std::vector<Vec3>& positions, std::vector<Vec3>& velocities) {
        for (Vec3& position : positions) position = about + r * (position - about);
        for (Vec3& velocity : velocities) velocity = r * velocity;
    };
    turn(chain.beads.position, chain.beads.velocity);
    turn(chain.linked.position, chain.linked.velocity);
    // Angular velocities are in body axes and stay as they are.
    for (auto& q : chain.linked.orientation) {
        Quat const turned = normalized(rotation * Quat{q[0], q[1], q[2], q[3]});
        q = {turned.w, turned.x, turned.y, turned.z};
    }
}

}  // namespace catena::scene
