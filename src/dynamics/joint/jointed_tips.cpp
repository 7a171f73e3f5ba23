// Collects the jointed tips of a rank and the characteristic length.
#include "dynamics/joint/jointed_tips.hpp"

#include <algorithm>

#include "dynamics/body_loads.hpp"
#include "joints/joint_models.hpp"

namespace catena {

JointedTip tip_of(TipJoint const& joint, Mat3 const& axes, Vector<double, 4> const& screw,
                  int restricted) {
    JointedTip tip;
    tip.ring = joint.ring;
    tip.type = joint.type;
    tip.axis = joint.axis;
    tip.first_axis = joint.first_axis;
    tip.rotation = joint.rotation;
    tip.translation = joint.translation;
    tip.axes = axes;
    tip.screw = dca::as_screw(screw);
    tip.restricted = restricted;
    tip.pitched = has_pitch(joint.type) && joint.pitch != 0;
    tip.cosine = dot(joint.first_axis, joint.axis);
    return tip;
}

namespace {

/// Motion of G in the ground, as the scene's start fixes it.
Motion ground_of(TipJoint const& joint, Quat const& orientation, Vec3 const& origin) {
    scene::Pose const motion = scene::joint_motion(joint.type, joint.axis, joint.first_axis,
                                                   joint.pitch, joint.q);  // Motion of G in J.
    return {orientation * to_quaternion(joint.rotation) * normalized(motion.orientation),
            Vec3::zero(),
            origin + to_matrix(orientation) * (joint.translation + joint.rotation * motion.origin),
            Vec3::zero()};
}

}  // namespace

std::vector<JointedTip> jointed_tips(ChainGroup const& group, Scene const& scene,
                                     BodyMotion& start) {
    std::vector<JointedTip> tips;
    for (LocalTip const& local : group.ends.tips) {
        tips.push_back(tip_of(local.joint, local.axes, local.screw, local.restricted));
        tips.back().body = local.body;
        tips.back().com = -group.bodies.r1[local.body];
        if (!local.joint.ring)
            tips.back().ground =
                ground_of(local.joint, as_quaternion(start.orientation[local.body]),
                          start.origin[local.body]);
    }
    for (LocalRing const& ring : group.ends.rings) {
        if (ring.last >= 0) {
            JointedTip& tip = tips[group.ends.tip_index(ring.last)];
            tip.first = ring.first;
            tip.neighbour = ring.neighbour;
            continue;
        }
        ChainSpec const& spec = scene.chains[group.chains[ring.chain].in_scene];
        LocalTip const there = local_tip(group, spec, -1);
        tips.push_back(tip_of(there.joint, there.axes, there.screw, there.restricted));
        tips.back().first = ring.first;
        tips.back().neighbour = ring.neighbour;
        tips.back().com = spec.bodies.com.back();
    }
    return tips;
}

double reach_of(ChainGroup const& group, Scene const& scene) {
    double longest = 0;
    for (GroupChain const& chain : group.chains) {
        ChainSpec const& spec = scene.chains[chain.in_scene];
        BodyArrays const& b = spec.bodies;
        double length = spec.tip == Tip::jointed ? norm(spec.tip_joint.translation) : 0.0, size = 0;
        for (LoopClosure const& loop : spec.loops)
            length = std::max({length, norm(loop.joint.translation), norm(loop.end_translation)});
        for (std::size_t k = 0; k < b.size(); ++k) {
            if (k > 0) length += norm(b.translation[k]);
            size = std::max(size, norm(b.com[k]) + radius_of_gyration(b.inertia[k], b.mass[k]));
        }
        longest = std::max(longest, length + size);
    }
    return longest;
}

}  // namespace catena
