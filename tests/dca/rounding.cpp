#include "tests/dca/rounding.hpp"

#include <Eigen/Dense>

#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using Exact = oracle::OracleResult<long double>;
struct Wrench {
    Vec3 torque, force;
};
Wrench in_double(oracle::SpatialForce<long double> const& f) {
    Wrench w;
    for (int i = 0; i < 3; ++i) w.torque[i] = static_cast<double>(f.torque[i]), w.force[i] = static_cast<double>(f.force[i]);
    return w;
}
Eigen::Vector3d as_eigen(Vec3 const& v) { return {v[0], v[1], v[2]}; }
double inertial(Eigen::Matrix3d const& inverse_inertia, Vec3 const& moment) { return (inverse_inertia * as_eigen(moment)).norm(); }

/// Sums of the sizes of what acts on a body, and of what that adds to the accelerations of its handles.
struct Terms {
    double force = 0, moment = 0, linear1 = 0, linear2 = 0, angular = 0;
};

Terms terms_of(ChainSpec const& chain, oracle::Kinematics<double> const& at, Exact const& exact, std::size_t k) {
    BodyArrays const& b = chain.bodies;
    Mat3 const& r = at.orientation[k];
    bool const last = k + 1 == b.size();
    Vec3 const arm1 = at.origin[k] - at.com_position[k],
               arm2 = last ? r * (chain.tip_joint.translation - b.com[k]) : at.origin[k + 1] - at.com_position[k];
    Wrench const inboard = in_double(exact.joint_force[k]);
    Wrench const outboard = in_double(last ? exact.tip_force : exact.joint_force[k + 1]);
    auto const wrench = b.wrench.empty() ? std::pair{Vec3::zero(), Vec3::zero()} : b.wrench[k];
    Eigen::Matrix3d inertia, turn;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) inertia(i, j) = b.inertia[k](i, j), turn(i, j) = r(i, j);
    Eigen::Matrix3d const inverse = turn * inertia.inverse() * turn.transpose();
    Terms t;
    for (Vec3 const& f : {inboard.force, outboard.force, wrench.second}) t.force += norm(f);
    for (Vec3 const& m : {inboard.torque, cross(arm1, inboard.force), outboard.torque, cross(arm2, outboard.force), wrench.first}) {
        t.moment += norm(m);
        t.angular += inertial(inverse, m);
    }
    t.linear1 = t.force / b.mass[k] + t.angular * norm(arm1);
    t.linear2 = t.force / b.mass[k] + t.angular * norm(arm2);
    return t;
}

}  // namespace

Nudged nudged(std::uint64_t seed, ChainSpec const& chain, oracle::Loads const& loads, Exact const& exact, double size) {
    Nudged n{perturbed(seed, chain, size), loads};
    BodyArrays& b = n.chain.bodies;
    if (b.size() == 0) return n;
    auto const at = oracle::kinematics<double>(chain, loads);
    Random random(seed);
    b.wrench.resize(b.size(), {Vec3::zero(), Vec3::zero()});
    Terms before;
    for (std::size_t k = 0; k < b.size(); ++k) {
        Terms const t = terms_of(chain, at, exact, k);
        b.wrench[k].first = b.wrench[k].first + random.vector(size * t.moment);
        b.wrench[k].second = b.wrench[k].second + random.vector(size * t.force);
        n.loads.gaps.emplace_back(random.vector(size * (t.angular + before.angular)), random.vector(size * (t.linear1 + before.linear2)));
        before = t;
    }
    return n;
}

}  // namespace catena::test
