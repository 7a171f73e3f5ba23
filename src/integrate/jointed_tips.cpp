#include "integrate/jointed_tips.hpp"

#include <algorithm>

#include "integrate/body_loads.hpp"

namespace catena {

std::vector<JointedTip> jointed_tips(ChainGroup const& group, BodyMotion& start) {
    std::vector<JointedTip> tips;
    for (LocalTip const& local : group.tips) {
        TipJoint const& joint = local.joint;
        Quat const orientation = as_quaternion(start.orientation[local.body]);
        scene::Pose const motion = scene::joint_motion(joint.type, joint.axis, joint.first_axis, joint.pitch, joint.q);  // of G in J
        JointedTip tip;
        tip.body = local.body;
        tip.type = joint.type;
        tip.axis = joint.axis;
        tip.first_axis = joint.first_axis;
        tip.rotation = joint.rotation;
        tip.translation = joint.translation;
        tip.axes = local.axes;
        tip.screw = {local.screw[0], local.screw[1]};
        tip.restricted = local.restricted;
        tip.pitched = joint.type == JointType::helical && joint.pitch != 0;
        tip.ground_rotation = orientation * to_quaternion(joint.rotation) * normalized(motion.orientation);
        tip.ground_origin = start.origin[local.body] + to_matrix(orientation) * (joint.translation + joint.rotation * motion.origin);
        tip.com = -group.r1[local.body];
        tip.cosine = dot(joint.first_axis, joint.axis);
        tips.push_back(tip);
    }
    return tips;
}

double reach_of(ChainGroup const& group, Scene const& scene) {
    double longest = 0;
    for (int const chain : group.chain) {
        ChainSpec const& spec = scene.chains[chain];
        BodyArrays const& b = spec.bodies;
        double length = spec.tip == Tip::jointed ? norm(spec.tip_joint.translation) : 0.0, size = 0;
        for (std::size_t k = 0; k < b.size(); ++k) {
            if (k > 0) length += norm(b.translation[k]);
            size = std::max(size, norm(b.com[k]) + radius_of_gyration(b.inertia[k], b.mass[k]));
        }
        longest = std::max(longest, length + size);
    }
    return longest;
}

}  // namespace catena
