// Implements the closure check of rings.
#include "bodies/ring.hpp"

#include <fmt/format.h>

#include <cmath>

#include "joints/joint_models.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

namespace {

/// Computes the closure error. `b` is the pose of the first body relative to the joint frame.
JointOpening opening_of(TipJoint const& joint, Pose const& b) {
    JointShape const shape{joint.axis, joint.first_axis, joint.pitch};
    return with_joint(joint.type, [&](auto model) {
        return decltype(model)::opening(shape, b.orientation, b.origin);
    });
}

}  // namespace

Reach reach_of(BodyArrays const& bodies) {
    Reach reach;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        Pose const next = next_pose(bodies, k, reach.end);
        if (k > 0) reach.length += norm(next.origin - reach.end.origin);
        reach.end = next;
    }
    return reach;
}

void check_ring(ChainSpec const& chain, Node const& node) {
    if (chain.base != Base::free)
        fail(node, "a ring on a fixed base", "write `base: free`, or join the tip to the ground");
    std::size_t const least = chain.is_beads() || chain.is_linked() ? 3 : 2;
    if (chain.size() < least)
        fail(node, fmt::format("{} bodies do not form a ring", chain.size()),
             fmt::format("give it {} or more", least));
}

void close_ring(ChainSpec& chain, Node const& node, Scene& scene) {
    TipJoint& joint = chain.tip_joint;
    Reach const reach = reach_of(chain.bodies);
    Pose const first = next_pose(chain.bodies, 0, {}), &end = reach.end;
    // All poses are relative to the last body, in which the joint frame is fixed.
    Quat const to_last = conjugate(end.orientation);
    if (!node.find("rotation")) joint.rotation = to_matrix(to_last * first.orientation);
    Vec3 const apart = to_matrix(to_last) * (first.origin - end.origin) - joint.translation;
    Pose const b{conjugate(to_quaternion(joint.rotation)) * (to_last * first.orientation),
                 transposed_times(joint.rotation, apart)};
    JointOpening const open = opening_of(joint, b);
    // A ring of zero length, with all joints at one point, is measured in absolute lengths.
    double const around = reach.length + norm(joint.translation), length = around > 0 ? around : 1;
    if (open.distance <= closure_tolerance * length && open.angle <= closure_tolerance) return;
    std::string const what = fmt::format(
        "the ring is open at the start: the first body is {:.3g} and {:.3g} rad from where the "
        "last body's "
        "joint holds it",
        open.distance, open.angle);
    if (open.distance <= closable * length && open.angle <= closable)
        return scene.note(what + ": the smallest change of the joints closes it");
    fail(node, what,
         fmt::format("move the bodies to within {:.3g} and {:.3g} rad of it, or correct "
                     "`translation` and `rotation`",
                     closable * length, closable));
}

}  // namespace catena::scene
