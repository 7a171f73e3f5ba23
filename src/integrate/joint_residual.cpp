// The local backward residual of forward dynamics in joint coordinates (formulas, "Residuals").
#include <algorithm>
#include <cmath>
#include <utility>

#include "integrate/joint_dynamics.hpp"

namespace catena {
namespace {

Quat as_quaternion(Vector<double, 4> const& v) { return {v[0], v[1], v[2], v[3]}; }
Mat3 as_matrix(Vector<double, 9> const& v) { return {{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]}}; }
Sym3 as_symmetric(Vector<double, 6> const& v) { return {{v[0], v[1], v[2], v[3], v[4], v[5]}}; }
double relative(double difference, double terms) { return terms == 0 ? 0.0 : difference / terms; }

struct BodyTerms {
    std::vector<Vec3> forces, moments;
};

/// |inertial - sum of terms| over the sum of their sizes.
double balance(Vec3 const& inertial, std::vector<Vec3> const& terms) {
    Vec3 difference = inertial;
    double size = norm(inertial);
    for (Vec3 const& t : terms) {
        difference = difference - t;
        size += norm(t);
    }
    return relative(norm(difference), size);
}

/// Acceleration of a handle along its joint's axes, and the sizes of its terms: what each force and moment on the body, and its
/// turning, adds to it (chapter, eqs 2.1-2.2).
struct HandleAcceleration {
    Vec3 linear, angular;
    double linear_terms, angular_terms;
};

}  // namespace

double JointDynamics::residual() {
    auto const inboard_axes = [&](std::int64_t k) {
        return transposed_times(to_matrix(as_quaternion(motion_.joint_turn[k])), as_matrix(group_.axes1[k]));
    };
    auto const wrench_at = [&](std::int64_t k) {  // of joint k: force and torque along its axes
        std::pair<Vec3, Vec3> w{Vec3::zero(), Vec3::zero()};
        auto const [origin, pitch] = joint_force_.view();
        for (int i = 0; i < group_.directions; ++i) (i < 3 ? w.first[i] : w.second[i - 3]) = origin[i * pitch + k];
        return w;
    };
    /// Forces on body k, and moments about its centre: applied, of the inboard joint, of the outboard joint; B.
    auto const loads_on = [&](std::int64_t k) {
        Mat3 const e1 = inboard_axes(k), e2 = as_matrix(group_.axes2[k]);
        auto const [f1, t1] = wrench_at(k);
        auto const [f2, t2] = group_.is_last[k] ? std::pair{Vec3::zero(), Vec3::zero()} : wrench_at(k + 1);
        Vec3 const force1 = e1 * f1, force2 = -(e2 * f2);
        return BodyTerms{{given_.wrenches ? force_[k] : Vec3::zero(), force1, force2},
                         {torque_[k], cross(group_.r1[k], force1), e1 * t1, cross(group_.r2[k], force2), -(e2 * t2)}};
    };
    auto const at_handle = [&](std::int64_t k, Vec3 const& r, Mat3 const& axes) {
        BodyTerms const terms = loads_on(k);
        Vec3 const w = motion_.omega[k], centripetal = cross(w, cross(w, r));
        double linear = norm(centripetal), angular = 0;
        for (Vec3 const& f : terms.forces) linear += group_.inverse_mass.view().at(k, 0) * norm(f);
        for (Vec3 const& m : terms.moments) {
            Vec3 const part = as_symmetric(group_.inverse_inertia[k]) * m;
            angular += norm(part);
            linear += norm(cross(part, r));
        }
        return HandleAcceleration{transposed_times(axes, acceleration_[k] + cross(alpha_[k], r) + centripetal),
                                  transposed_times(axes, alpha_[k]), linear, angular};
    };
    auto const radius_of_gyration = [&](std::int64_t k) {
        Vector<double, 6> const j = group_.inertia[k];
        return std::sqrt(0.5 * (j[0] + j[2] + j[5]) * group_.inverse_mass.view().at(k, 0));
    };
    Field<8> outboard(group_.size);
    for (std::int64_t k = 0; k < group_.size; ++k) {
        HandleAcceleration const h = at_handle(k, group_.r2[k], as_matrix(group_.axes2[k]));
        outboard.set(k,
                     {{h.linear[0], h.linear[1], h.linear[2], h.angular[0], h.angular[1], h.angular[2], h.linear_terms, h.angular_terms}});
    }
    exchange_from_inboard(communicator_, group_, outboard.view());

    ConstDirectionsView const bias = std::as_const(bias_).view();  // -c, with g at a chain's first joint
    auto const closing = [&, origin = bias.origin, pitch = bias.pitch](std::int64_t k) {
        HandleAcceleration const mine = at_handle(k, group_.r1[k], inboard_axes(k));
        Vector<double, 8> const before = group_.is_first[k] ? Vector<double, 8>::zero() : outboard.view().load(k - 1);
        Vec3 const linear_bias{{origin[k], origin[pitch + k], origin[2 * pitch + k]}};
        double linear = norm(mine.linear - Vec3{{before[0], before[1], before[2]}} + linear_bias), angular = 0, angular_bias = 0;
        if (group_.joint[k] == JointType::revolute) {
            angular_bias = std::hypot(origin[3 * pitch + k], origin[4 * pitch + k]);
            angular = std::hypot(mine.angular[0] - before[3] + origin[3 * pitch + k], mine.angular[1] - before[4] + origin[4 * pitch + k]);
        }
        // One spatial equation: angles count by the body's size, so that the measure does not depend on the unit of length.
        double const size = norm(group_.r1[k]) + radius_of_gyration(k);
        return relative(linear + size * angular,
                        mine.linear_terms + before[6] + norm(linear_bias) + size * (mine.angular_terms + before[7] + angular_bias));
    };

    double worst = 0;
    for (std::int64_t k = 0; k < group_.size; ++k) {
        BodyTerms const terms = loads_on(k);
        double const newton = balance(group_.mass.view().at(k, 0) * acceleration_[k], terms.forces);
        double const euler = balance(as_symmetric(group_.inertia[k]) * alpha_[k], terms.moments);
        worst = larger(worst, larger(newton, larger(euler, group_.joint[k] == JointType::free ? 0.0 : closing(k))));
    }
    return communicator_.max(worst);
}

}  // namespace catena
