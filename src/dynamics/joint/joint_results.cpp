// Accelerations and joint forces of a solution in joint coordinates, in ground axes, and its
// potential energy.
#include "dynamics/joint/joint_solution.hpp"
#include "dynamics/joint/out_of_plane.hpp"
#include "joints/joint_models.hpp"

namespace catena {

Screw<double> JointSolution::screw(std::int64_t k) const {
    if (!group.joints.has_screws) return {1, 0};
    return dca::as_screw(group.joints.screw.view().load(k));
}

Screw<double> JointSolution::outboard_screw(std::int64_t k) const {
    if (!group.ends.has_jointed_tip(k))
        return k + 1 < group.size || group.neighbours.outboard >= 0 ? screw(k + 1)
                                                                    : Screw<double>{1, 0};
    return dca::as_screw(group.ends.tip_of(k).screw);
}

JointSolution::Pair JointSolution::along_axes(ConstDirectionsView forces, std::int64_t at,
                                              Screw<double> const& s) const {
    dca::AlongAxes<double> const f = dca::along_axes(s, load_first(forces, at, group.directions));
    return {f.linear, f.angular};
}

/// Force of external wrenches and carried beads on body k, W.
Vec3 JointSolution::outside_force(std::int64_t k) const {
    Vec3 f = Vec3::zero();
    if (bead_force.origin)
        for (std::int64_t i = group.carried.offset[k]; i < group.carried.offset[k + 1]; ++i)
            f = f + bead_force.load(i);
    return given.wrenches ? f + given.wrench_force[k] : f;
}

/// Bodies of a solution as force terms see them (ForceTerm::add_on_body()).
struct SolvedBodies {
    JointSolution const& of;
    BodyLoads const& given;

    Vec3 omega(std::int64_t k) const { return of.omega.load(k); }
    Vec3 velocity(std::int64_t k) const { return of.velocity.load(k); }
    Vec3 r1(std::int64_t k) const { return of.group.bodies.r1[k]; }
    template <int D>
    Vector<double, D> load(Field<D> const& field, std::int64_t k) const {
        return field[k];
    }
};

Vec3 JointSolution::force_of_terms(std::int64_t k) const {
    Vec3 moment = Vec3::zero(), push = Vec3::zero();
    terms::for_each([&](auto term) {
        decltype(term)::add_on_body(SolvedBodies{*this, given}, k, moment, push);
    });
    return push;
}

BodyResults JointSolution::results(Communicator const& communicator) const {
    BodyResults r;
    for (std::int64_t k = 0; k < group.size; ++k) {
        Mat3 const to_ground = orientation(k) * axes1(k);
        Vec3 gravity = given.gravity;
        if (group.planar)
            gravity = plus_scaled(gravity, -dot(to_ground.column(2), gravity), to_ground.column(2));
        r.alpha.push_back(orientation(k) * alpha.load(k));
        r.acceleration.push_back(orientation(k) * acceleration.load(k) + gravity);
        Pair const inboard = along_axes(joint_force, k, screw(k));
        Vec3 const t = to_ground * inboard.torque, v = to_ground * inboard.force;
        r.joint_force.push_back({{t[0], t[1], t[2], v[0], v[1], v[2]}});
    }
    if (group.planar) add_across_plane(communicator, r);
    for (LocalTip const& tip : group.ends.tips) {
        Pair const found = along_axes(tip_force, tip.body, dca::as_screw(tip.screw));
        Mat3 const to_ground = orientation(tip.body) * axes2(tip.body);
        Vec3 const push = -(to_ground * found.force);
        // The handles coincide at the origin of G, which slides along the joint's axis.
        Vec3 const arm = orientation(tip.body) *
                         (r2(tip.body) - group.bodies.r1[tip.body] - tip.joint.translation);
        Vec3 const moment = cross(arm, push) - to_ground * found.torque;
        r.tip_force.push_back({group.scene_chain(tip.body),
                               {{moment[0], moment[1], moment[2], push[0], push[1], push[2]}}});
    }
    add_loop_forces(r);
    return r;
}

void JointSolution::add_loop_forces(BodyResults& r) const {
    for (std::size_t l = 0; loops && l < group.loops.own.size(); ++l) {
        LocalLoop const& loop = group.loops.own[l];
        bool const grounded = loop.inboard == LoopClosure::ground;
        LoopEnd const& end = loops->ends()[l].inboard;
        Mat3 const to_ground = grounded ? Mat3::identity() : orientation(loop.inboard);
        Vec3 const com = grounded ? Vec3::zero() : -group.bodies.r1[loop.inboard];
        dca::AlongAxes<double> const along =
            dca::along_axes(dca::as_screw(loop.screw), loops->force()[l]);
        Vec3 const push = -(to_ground * (end.axes * along.linear));
        // A joint that slides acts at the origin of G.
        Vec3 const arm = to_ground * (end.arm + com - loop.joint.translation);
        Vec3 const moment = cross(arm, push) - to_ground * (end.axes * along.angular);
        r.loop_force.push_back({group.scene_chain(group.pieces[loop.piece].local),
                                {{moment[0], moment[1], moment[2], push[0], push[1], push[2]}}});
    }
}

/// Adds the force along the axis and the torque across it, in planar chains. With a jointed tip,
/// the ground holds the chain across its plane at both ends, so that these are not determined: they
/// stay 0.
void JointSolution::add_across_plane(Communicator const& communicator, BodyResults& r) const {
    std::vector<NeededWrench> needed;
    for (std::int64_t k = 0; k < group.size; ++k) {
        Mat3 const to_ground = orientation(k);
        Vec3 const needed_force =
            group.bodies.mass.view().at(k, 0) *
                (r.acceleration[static_cast<std::size_t>(k)] - given.gravity) -
            outside_force(k) - to_ground * force_of_terms(k);
        Vec3 const moment = to_ground * (as_symmetric(group.bodies.inertia[k]) * alpha.load(k) +
                                         gyroscopic_torque(k) - torque.load(k));
        Vec3 const to_next = group.ends.is_last[k]
                                 ? Vec3::zero()
                                 : to_ground * (group.bodies.r2[k] - group.bodies.r1[k]);
        needed.push_back(
            {needed_force, moment + cross(to_ground * -group.bodies.r1[k], needed_force), to_next});
    }
    auto const sums = sums_from_tip(group, communicator, needed);
    for (dca::Piece const& piece : group.pieces) {
        if (group.partition.has_jointed_tip(piece.chain)) continue;
        for (std::int64_t k = piece.local; k < piece.local + piece.count; ++k) {
            Vec3 const axis = orientation(k) * axes_of(group.bodies.axes1[k]).column(2);
            auto const& [needed_force, needed_torque] = sums[k];
            Vec3 const along = dot(axis, needed_force) * axis,
                       across = plus_scaled(needed_torque, -dot(axis, needed_torque), axis);
            for (int i = 0; i < 3; ++i) {
                r.joint_force[k][i] += across[i];
                r.joint_force[k][3 + i] += along[i];
            }
        }
    }
}

PotentialEnergy potential_of(ChainGroup const& group, BodyLoads const& given, Field<4> const& q,
                             BodyMotion const& motion) {
    return potential_of(given, group.size, [&](std::int64_t k) {
        Vec3 const com =
            motion.origin[k] - to_matrix(as_quaternion(motion.orientation[k])) * group.bodies.r1[k];
        return terms::PlacedBody{k, group.bodies.mass.view().at(k, 0), com,
                                 group.joints.type[static_cast<std::size_t>(k)], q[k]};
    });
}

}  // namespace catena
