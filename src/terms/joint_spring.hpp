// Springs of joints.
#pragma once

#include "joints/joint_models.hpp"
#include "math/rotation.hpp"
#include "terms/force_term.hpp"

namespace catena {

/// Torque of a spherical joint's spring on the outboard body, B. `rotation` is the rotation of B in
/// the joint frame. The energy is 1/2 sum k_i theta_i^2, with theta the rotation vector of B from
/// `rest`. Its gradient contains the inverse right Jacobian of SO(3) (Sola et al., "A micro Lie
/// theory", 2018, eq 144).
CATENA_HD Vec3 spherical_spring_torque(Vec3 const& stiffness, Quat const& rest,
                                       Quat const& rotation) {
    Vec3 const theta = rotation_vector(conjugate(rest) * rotation);
    Vec3 const k_theta{{stiffness[0] * theta[0], stiffness[1] * theta[1], stiffness[2] * theta[2]}};
    double const angle = norm(theta);
    CosSin const half = cos_sin(0.5 * angle);
    // Coefficient (1 - (angle/2) cot(angle/2)) / angle^2, with its series (1/12 + ...) for small
    // angles.
    double const c = angle > 1e-3 ? (1.0 - 0.5 * angle * half.cos / half.sin) / (angle * angle)
                                  : 1.0 / 12.0 + angle * angle / 720.0;
    Vec3 const t1 = cross(theta, k_theta), t2 = cross(theta, t1);
    return -1.0 * (k_theta - 0.5 * t1 + c * t2);
}
/// Energy of a spherical joint's spring: 1/2 sum k_i theta_i^2.
inline double spherical_spring_energy(Vec3 const& stiffness, Quat const& rest,
                                      Quat const& rotation) {
    Vec3 const theta = rotation_vector(conjugate(rest) * rotation);
    return 0.5 * (stiffness[0] * theta[0] * theta[0] + stiffness[1] * theta[1] * theta[1] +
                  stiffness[2] * theta[2] * theta[2]);
}

}  // namespace catena

namespace catena::terms {

struct JointSpring : ForceTerm {
    static constexpr char const* name = "springs";
    static constexpr bool known_to_peers = true;
    static constexpr char const* energy = "springs";
    static constexpr bool always_has_energy = true;
    static constexpr bool acts_along_joints = true;
    static constexpr char const* on_one = "joint";
    static constexpr char const* on_many = "joints";
    static constexpr char const* in_check = "springs";
    static constexpr char const* saving = "joint springs";

    static std::int64_t count(Scene const&, ChainSpec const& chain) {
        return count_of(chain.bodies.stiffness);
    }
    template <class Use>
    static void columns(Use const& use) {
        use(Column<Vec3>{&BodyArrays::stiffness, 1});
        use(Column<std::array<double, 4>>{&BodyArrays::rest, 3});
    }
    template <class Table>
    static void read_table(Table& table, ChainSpec& chain) {
        if (table.has("rest"))
            table.need("stiffness", "springs that are relaxed at `rest` have one");
        if (!table.has("stiffness")) return;
        table.resistances("stiffness", chain.bodies.stiffness);
        table.positions("rest", chain.bodies.rest);
    }
    static void put(Scene& scene, std::size_t bodies) {
        scene.chains[0].bodies.stiffness.assign(bodies, Vec3{{1, 1, 1}});
    }

    template <template <int> class F>
    struct Arrays {
        F<3> stiffness;  // One number per joint coordinate.
        F<4> rest;       // As BodyArrays::q.
        bool springs = false;
    };
    template <class To, class From, class Convert>
    static To converted(From const& from, Convert const& convert) {
        return {convert(from.stiffness), convert(from.rest), from.springs};
    }
    template <class Maker, class To>
    static void collect(Maker const& maker, To& to) {
        to.springs = maker.template any<JointSpring>();
        if (!to.springs) return;
        to.stiffness = maker.template field<3>(
            [](ChainSpec const& c, std::size_t k) { return entry(c.bodies.stiffness, k); });
        to.rest = maker.template field<4>([](ChainSpec const& c, std::size_t k) {
            BodyArrays const& b = c.bodies;
            if (!b.rest.empty())
                return Vector<double, 4>{{b.rest[k][0], b.rest[k][1], b.rest[k][2], b.rest[k][3]}};
            return Vector<double, 4>{{is_ball(b.joint[k]) ? 1.0 : 0.0, 0, 0, 0}};
        });
    }
    /// Adds the spring's load along one coordinate q that is an angle about an axis or a length.
    template <class Real>
    CATENA_HD static Real plus(Real const& along, Real const& stiffness, Real const& q,
                               Real const& rest) {
        return along - stiffness * (q - rest);
    }
    /// Adds the loads along the coordinates of a joint.
    template <class Joint, class Vector3>
    CATENA_HD static void add_along(Joint const& joint, Vector3& along) {
        if (!joint.given.springs) return;
        auto const stiffness = joint.load(joint.given.stiffness);
        auto const rest = joint.load(joint.given.rest);
        if (!is_ball(joint.type)) {
            for (int i = 0; i < 3; ++i)
                along[i] = plus(along[i], stiffness[i], joint.q[i], rest[i]);
        } else if constexpr (Joint::is_one) {
            along = along +
                    spherical_spring_torque(stiffness, as_quaternion(rest), as_quaternion(joint.q));
        }
    }
    template <class Axis>
    CATENA_HD static void add_about_axis(Axis const& axis, double& along) {
        if (axis.given.springs)
            along = plus(along, axis.at(axis.given.stiffness), axis.q(), axis.at(axis.given.rest));
    }
    template <class From>
    static double energy_of(From const& from, PlacedBody const& body) {
        if (!from.springs) return 0;
        Vec3 const stiffness = from.stiffness[body.k];
        Vector<double, 4> const rest = from.rest[body.k];
        if (is_ball(body.joint))
            return spherical_spring_energy(stiffness, as_quaternion(rest), as_quaternion(body.q));
        double sum = 0;
        if (!floats(body.joint))
            for (int i = 0; i < 3; ++i)
                sum += 0.5 * stiffness[i] * (body.q[i] - rest[i]) * (body.q[i] - rest[i]);
        return sum;
    }
};

}  // namespace catena::terms
