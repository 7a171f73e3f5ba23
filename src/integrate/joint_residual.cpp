// The local backward residual of forward dynamics in joint coordinates (formulas, "Residuals").
#include <algorithm>
#include <cmath>
#include <utility>

#include "integrate/joint_dynamics.hpp"

namespace catena {
namespace {

struct BodyTerms {
    std::vector<Vec3> forces, moments;
    double moment_sizes = 0;  // |r| |f| of forces: what their moments' rounding goes by, however short the moment
};

/// |inertial - sum of terms| over the sum of their sizes and `more`, what cancelled within them or was taken out of them.
double balance(Vec3 const& inertial, std::vector<Vec3> const& terms, double more) {
    Vec3 difference = inertial;
    double size = norm(inertial) + more;
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
    auto const is_tip = [&](std::int64_t k) { return group_.has_jointed_tip(k); };
    auto const outboard_screw = [&](std::int64_t k) {
        if (!is_tip(k)) return k + 1 < group_.size || group_.neighbour_outboard >= 0 ? screw(k + 1) : Screw<double>{1, 0};
        Vec3 const tip = group_.tip_of(k).screw;
        return Screw<double>{tip[0], tip[1]};
    };
    /// Force and torque along a joint's axes.
    auto const wrench = [&](ConstDirectionsView forces, std::int64_t at, Screw<double> const& s) {
        double f[6] = {0, 0, 0, 0, 0, 0};
        for (int i = 0; i < group_.directions; ++i) f[i] = forces.origin[i * forces.pitch + at];
        return std::pair{Vec3{{f[0], f[1], s.c * f[2] + s.s * f[5]}}, Vec3{{f[3], f[4], s.c * f[5] - s.s * f[2]}}};
    };
    auto const outboard_wrench = [&](std::int64_t k) {
        if (is_tip(k)) return wrench(std::as_const(tip_force_).view(), k, outboard_screw(k));
        if (group_.is_last[k]) return std::pair{Vec3::zero(), Vec3::zero()};
        return wrench(std::as_const(joint_force_).view(), k + 1, outboard_screw(k));
    };
    /// Forces on body k, and moments about its centre: applied, of the inboard joint, of the outboard joint; B.
    auto const loads_on = [&](std::int64_t k) {
        Mat3 const e1 = inboard_axes(k), e2 = axes2(k);
        auto const [f1, t1] = wrench(std::as_const(joint_force_).view(), k, screw(k));
        auto const [f2, t2] = outboard_wrench(k);
        Vec3 const force1 = e1 * f1, force2 = -(e2 * f2);
        return BodyTerms{{has_forces_ ? force_[k] : Vec3::zero(), force1, force2},
                         {torque_[k], cross(group_.r1[k], force1), e1 * t1, cross(r2(k), force2), -(e2 * t2)},
                         norm(group_.r1[k]) * norm(force1) + norm(r2(k)) * norm(force2)};
    };
    auto const at_handle = [&](std::int64_t k, Vec3 const& r, Mat3 const& axes) {
        BodyTerms const terms = loads_on(k);
        Vec3 const w = motion_.omega[k], centripetal = cross(w, cross(w, r));
        double linear = norm(centripetal) + norm(given_.gravity), angular = 0;
        for (Vec3 const& f : terms.forces) linear += group_.inverse_mass.view().at(k, 0) * norm(f);
        for (Vec3 const& m : terms.moments) {
            Vec3 const part = as_symmetric(group_.inverse_inertia[k]) * m;
            angular += norm(part);
            linear += norm(cross(part, r));
        }
        return HandleAcceleration{transposed_times(axes, acceleration_[k] + cross(alpha_[k], r) + centripetal),
                                  transposed_times(axes, alpha_[k]), linear, angular};
    };
    auto const outboard_handle = [&](std::int64_t k) {
        HandleAcceleration const h = at_handle(k, r2(k), axes2(k));
        return Vector<double, 8>{
            {h.linear[0], h.linear[1], h.linear[2], h.angular[0], h.angular[1], h.angular[2], h.linear_terms, h.angular_terms}};
    };
    auto const gyration = [&](std::int64_t k) { return radius_of_gyration(as_symmetric(group_.inertia[k]), group_.mass.view().at(k, 0)); };
    /// |D^T (outboard - inboard) + bias| over its terms. One spatial equation: angles count by the body's `size`, so that the measure
    /// does not depend on the unit of length.
    auto const closing = [&](Vector<double, 8> const& out, Vector<double, 8> const& in, ConstDirectionsView bias, std::int64_t at,
                             Screw<double> const& s, int restricted, double size) {
        Vector<double, 8> d;
        for (int i = 0; i < 8; ++i) d[i] = out[i] - in[i];
        double e[6] = {d[0], d[1], s.c * d[2] - s.s * d[5], d[3], d[4], s.s * d[2] + s.c * d[5]};
        double b[6] = {0, 0, 0, 0, 0, 0};
        for (int i = 0; i < 6; ++i) {
            if (i < restricted) b[i] = bias.origin[i * bias.pitch + at];
            e[i] = i < restricted ? e[i] + b[i] : 0.0;
        }
        auto const sizes = [&](double const(&v)[6]) {
            return norm(Vec3{{v[0], v[1], s.c * v[2] + s.s * v[5]}}) + size * norm(Vec3{{v[3], v[4], s.c * v[5] - s.s * v[2]}});
        };
        return relative(sizes(e), out[6] + in[6] + size * (out[7] + in[7]) + sizes(b));
    };

    Vector<double, 8> before = Vector<double, 8>::zero();  // handle 2 of body k - 1
    Vector<double, 8> const last = group_.neighbour_outboard >= 0 ? outboard_handle(group_.size - 1) : before;
    communicator_.exchange(std::as_bytes(std::span(last.data)), group_.neighbour_outboard, std::as_writable_bytes(std::span(before.data)),
                           group_.neighbour_inboard);
    double worst = 0;
    for (std::int64_t k = 0; k < group_.size; ++k) {
        BodyTerms terms = loads_on(k);
        // The accelerated ground has taken the weight out of the forces: where bodies fall freely, only its rounding is left.
        double const mass = group_.mass.view().at(k, 0), weight = mass * norm(given_.gravity);
        worst = larger(worst, balance(mass * acceleration_[k], terms.forces, weight));
        Vec3 inertial = as_symmetric(group_.inertia[k]) * alpha_[k];
        if (group_.planar) {  // the other moments are not solved for
            Vec3 const axis = inboard_axes(k).column(2);
            inertial = dot(axis, inertial) * axis;
            for (Vec3& moment : terms.moments) moment = dot(axis, moment) * axis;
        }
        worst = larger(worst, balance(inertial, terms.moments, terms.moment_sizes + weight * norm(group_.r1[k])));
        HandleAcceleration const mine = at_handle(k, group_.r1[k], inboard_axes(k));
        Vector<double, 8> const here{{mine.linear[0], mine.linear[1], mine.linear[2], mine.angular[0], mine.angular[1], mine.angular[2],
                                      mine.linear_terms, mine.angular_terms}};
        if (group_.is_first[k]) before = Vector<double, 8>::zero();
        double const size = norm(group_.r1[k]) + gyration(k);
        worst = larger(worst, closing(here, before, std::as_const(bias_).view(), k, screw(k), group_.restricted(k), size));
        before = outboard_handle(k);
        if (!is_tip(k)) continue;
        int const restricted = group_.tip_of(k).restricted;
        worst = larger(worst, closing(Vector<double, 8>::zero(), before, std::as_const(tip_bias_).view(), k, outboard_screw(k), restricted,
                                      norm(r2(k)) + gyration(k)));
    }
    return communicator_.max(worst);
}

}  // namespace catena
