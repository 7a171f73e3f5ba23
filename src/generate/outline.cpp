// Implements the outlines of the three kinds of chains.
#include "generate/outline.hpp"

#include <algorithm>

#include "scene/branches.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

namespace {

void add_carried(Outline& outline, CarriedBeads const& carried, std::size_t k, Pose const& pose) {
    if (carried.offset.empty()) return;
    for (auto b = static_cast<std::size_t>(carried.offset[k]);
         b < static_cast<std::size_t>(carried.offset[k + 1]); ++b)
        outline.points.push_back(pose.origin + to_matrix(pose.orientation) * carried.position[b]);
}

Outline outline_of(BeadArrays const& beads) {
    Outline outline{beads.position, 0};
    for (double const length : beads.length) outline.link = std::max(outline.link, length);
    return outline;
}

Outline outline_of(BodyArrays const& bodies, Parents parents) {
    Outline outline;
    std::vector<Pose> poses;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        Pose const inboard = k > 0 ? poses[inboard_of(parents, k)] : Pose{};
        Pose const& pose = poses.emplace_back(next_pose(bodies, k, inboard));
        if (k > 0) outline.link = std::max(outline.link, norm(pose.origin - inboard.origin));
        outline.points.push_back(pose.origin);
        outline.points.push_back(pose.origin + to_matrix(pose.orientation) * bodies.com[k]);
        outline.link = std::max(outline.link, norm(bodies.com[k]));
        add_carried(outline, bodies.carried, k, pose);
    }
    return outline;
}

Outline outline_of(LinkedArrays const& linked) {
    Outline outline;
    for (std::size_t k = 0; k < linked.size(); ++k) {
        auto const& q = linked.orientation[k];
        Pose const pose{{q[0], q[1], q[2], q[3]}, linked.position[k]};
        for (Vec3 const& end : {Vec3::zero(), linked.inboard[k], linked.outboard[k]})
            outline.points.push_back(pose.origin + to_matrix(pose.orientation) * end);
        outline.link = std::max(
            {outline.link, linked.length[k], norm(linked.inboard[k]), norm(linked.outboard[k])});
        add_carried(outline, linked.carried, k, pose);
    }
    return outline;
}

}  // namespace

Outline outline_of(ChainSpec const& chain) {
    return chain.is_beads()    ? outline_of(chain.beads)
           : chain.is_linked() ? outline_of(chain.linked)
                               : outline_of(chain.bodies, chain.parent);
}

}  // namespace catena::scene
