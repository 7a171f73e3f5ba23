// Results, residual and potential energy of rigid chains.
#include "dynamics/rigid/rigid_solution.hpp"

#include "dynamics/rigid/rigid_loads.hpp"
#include "joints/joint_models.hpp"
#include "kinematics/ring_ends.hpp"

namespace catena {

PotentialEnergy potential_of(ChainGroup const& group, BodyLoads const& given,
                             Field<3> const& position, Field<4> const& orientation) {
    return potential_of(given, group.size, [&](std::int64_t k) {
        auto const at = static_cast<std::size_t>(k);
        terms::PlacedBody body{
            k, group.bodies.mass.view().at(k, 0), position[k], group.joints.type[at], {}};
        if (!given.springs || !is_ball(body.joint)) return body;
        Quat const inboard =
            group.ends.is_first[at] ? Quat::identity() : as_quaternion(orientation[k - 1]);
        body.q = as_vector(turn_of_joint(inboard, as_quaternion(group.joints.rotation[k]),
                                         as_quaternion(orientation[k])));
        return body;
    });
}

BodyResults RigidSolution::results() const {
    BodyResults r;
    for (std::int64_t k = 0; k < group.size; ++k) {
        r.alpha.push_back(axes(k) * alpha.load(k));
        r.acceleration.push_back(acceleration.load(k));
        Vec3 const f = inboard_force(k);
        r.joint_force.push_back({{0, 0, 0, f[0], f[1], f[2]}});
    }
    for (LocalTip const& tip : group.ends.tips) {
        Vec3 const f = force_of_tip(tip.body);
        r.tip_force.push_back({group.scene_chain(tip.body), {{0, 0, 0, -f[0], -f[1], -f[2]}}});
    }
    return r;
}

std::vector<Vector<double, 4>> RigidSolution::beyond_tips(Communicator const& communicator) const {
    return beyond_tips_of<4>(group, communicator, [&](std::int64_t k) {
        HandleAcceleration const a = handle_acceleration(k, group.bodies.r1[k]);
        return Vector<double, 4>{{a.value[0], a.value[1], a.value[2], a.terms}};
    });
}

double RigidSolution::residual(Communicator const& communicator) const {
    // Closing error of a joint at the accelerations of its handles, relative to the size of its own
    // terms.
    auto const closing = [&](Vec3 const& difference, double terms, ConstView<3> along,
                             ConstDirectionsView turning, std::int64_t k) {
        if (!group.linked) return relative(norm(difference), terms);
        double const s = turning.load<1>(k)[0];
        return relative(dot(along.load(k), difference) + s, terms + s);
    };
    /// Acceleration of handle 2, W, and the size of its terms.
    Field<4> point(group.size);
    for (std::int64_t k = 0; k < group.size; ++k) {
        HandleAcceleration const a = handle_acceleration(k, group.bodies.r2[k]);
        point.set(k, {{a.value[0], a.value[1], a.value[2], a.terms}});
    }
    exchange_from_inboard(communicator, group, point.view());
    auto const beyond = beyond_tips(communicator);
    double worst = 0;
    for (std::int64_t k = 0; k < group.size; ++k) {
        worst = larger(worst, newton_euler_residual(k));
        Vector<double, 4> const own = point[k];
        if (group.ends.has_jointed_tip(k)) {
            Vector<double, 4> const there = beyond[group.ends.tip_index(k)], apart = there - own;
            worst = larger(worst, closing(Vec3{{apart[0], apart[1], apart[2]}}, own[3] + there[3],
                                          tip_direction, tip_bias, k));
        }
        if (floats(group.joints.type[static_cast<std::size_t>(k)])) continue;
        HandleAcceleration const mine = handle_acceleration(k, group.bodies.r1[k]);
        Vector<double, 4> const before =
            group.ends.is_first[k] ? Vector<double, 4>::zero() : point.view().load(k - 1);
        worst = larger(worst, closing(mine.value - Vec3{{before[0], before[1], before[2]}},
                                      mine.terms + before[3], direction, bias, k));
    }
    return communicator.max(worst);
}

Vec3 RigidSolution::inboard_force(std::int64_t k) const {
    return group.linked ? joint_force.load<1>(k)[0] * direction.load(k) : joint_force.load<3>(k);
}
Vec3 RigidSolution::force_of_tip(std::int64_t k) const {
    return group.linked ? tip_force.load<1>(k)[0] * tip_direction.load(k) : tip_force.load<3>(k);
}
Vec3 RigidSolution::outboard_force(std::int64_t k) const {
    if (group.ends.has_jointed_tip(k)) return force_of_tip(k);
    return group.ends.is_last[k] ? Vec3::zero() : inboard_force(k + 1);
}

/// Acceleration of a handle. `terms` sums the sizes of the contributions of each force, each moment
/// and the rotation of the body (chapter, eqs 2.1-2.2).
RigidSolution::HandleAcceleration RigidSolution::handle_acceleration(std::int64_t k,
                                                                     Vec3 const& r) const {
    Mat3 const to_ground = axes(k);
    Vec3 const w = omega.load(k), centripetal = cross(w, cross(w, r));
    Vec3 const f1 = inboard_force(k), f2 = outboard_force(k);
    double terms = norm(centripetal) + group.bodies.inverse_mass.view().at(k, 0) *
                                           (norm(force.load(k)) + norm(f1) + norm(f2));
    for (Vec3 const& applied :
         {moment.load(k), cross(group.bodies.r1[k], transposed_times(to_ground, f1)),
          cross(group.bodies.r2[k], transposed_times(to_ground, f2))})
        terms += norm(cross(as_symmetric(group.bodies.inverse_inertia[k]) * applied, r));
    return {acceleration.load(k) + to_ground * (cross(alpha.load(k), r) + centripetal), terms};
}

double RigidSolution::newton_euler_residual(std::int64_t k) const {
    Mat3 const to_ground = axes(k);
    Vec3 const f = force.load(k), f1 = inboard_force(k), f2 = outboard_force(k);
    Vec3 const ma = group.bodies.mass.view().at(k, 0) * acceleration.load(k);
    double const newton =
        relative(norm(ma - f - f1 + f2), norm(ma) + norm(f) + norm(f1) + norm(f2));
    Sym3 const inertia = as_symmetric(group.bodies.inertia[k]);
    if (inertia.data[0] == 0) return newton;  // A bead has no rotation.
    Vec3 const w = omega.load(k), t = torque.load(k), j_alpha = inertia * alpha.load(k),
               gyroscopic = cross(w, inertia * w);
    Vec3 const t1 = cross(group.bodies.r1[k], transposed_times(to_ground, f1)),
               t2 = cross(group.bodies.r2[k], transposed_times(to_ground, f2));
    double const euler = relative(norm(j_alpha + gyroscopic - t - t1 + t2),
                                  norm(j_alpha) + norm(gyroscopic) + norm(t) + norm(t1) + norm(t2));
    return larger(newton, euler);
}

}  // namespace catena
