// Implements the table of a chain for other programs and the conversion of their answers.
#include "bench/peer_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "dynamics/body_loads.hpp"
#include "joints/joint_models.hpp"
#include "math/rotation.hpp"
#include "scene/branch_limits.hpp"

namespace catena::command {
namespace {

/// Joints that the table knows.
enum class PeerJoint { revolute, ball, slide, universal };

/// A body of the table with its joint, state and loads.
struct PeerBody {
    double mass = 0;
    Vec3 com = Vec3::zero();
    Sym3 inertia = Sym3::zero();
    PeerJoint joint = PeerJoint::revolute;
    Vec3 axis = Vec3::zero();
    Mat3 rotation = Mat3::identity();
    Vec3 translation = Vec3::zero();
    std::array<double, 4> q{0, 0, 0, 0};
    Vec3 qd = Vec3::zero(), torque = Vec3::zero(), wrench_torque = Vec3::zero(),
         wrench_force = Vec3::zero();
};
/// Number of columns of the table.
constexpr std::size_t columns = 42;

/// Appends a vector, a body or a chain to the table.
void append(std::vector<double>& table, Vec3 const& v) {
    table.insert(table.end(), v.data, v.data + 3);
}

void append(std::vector<double>& table, PeerBody const& b) {
    table.push_back(b.mass);
    append(table, b.com);
    for (auto const& [i, j] : {std::pair{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}})
        table.push_back(b.inertia(i, j));
    table.push_back(static_cast<double>(b.joint));
    append(table, b.axis);
    table.insert(table.end(), b.rotation.data, b.rotation.data + 9);
    append(table, b.translation);
    table.insert(table.end(), b.q.begin(), b.q.end());
    for (Vec3 const& v : {b.qd, b.torque, b.wrench_torque, b.wrench_force}) append(table, v);
}

/// Returns an entry of a list; zero if the list is empty.
Vec3 entry(std::vector<Vec3> const& list, std::size_t k) {
    return list.empty() ? Vec3::zero() : list[k];
}

Quat quaternion(std::array<double, 4> const& q) { return {q[0], q[1], q[2], q[3]}; }

/// Returns the joint's torque plus that of its spring and damper in the present state.
Vec3 torque_of(BodyArrays const& b, std::size_t k) {
    Vec3 torque = entry(b.torque, k);
    Vec3 const stiffness = entry(b.stiffness, k), damping = entry(b.damping, k);
    bool const sprung = norm(stiffness) > 0;
    if (pivots(b.joint[k])) {
        torque[0] -= sprung ? stiffness[0] * (b.q[k][0] - (b.rest.empty() ? 0 : b.rest[k][0])) : 0;
    } else if (sprung) {
        Quat const rest = b.rest.empty() ? Quat::identity() : quaternion(b.rest[k]);
        torque = torque + spherical_spring_torque(stiffness, rest, quaternion(b.q[k]));
    }
    for (int i = 0; i < 3; ++i) torque[i] -= damping[i] * b.qd[k][i];
    return torque;
}

/// Returns the row of a body.
PeerBody body_of(BodyArrays const& bodies, std::size_t k) {
    PeerBody b{bodies.mass[k], bodies.com[k],        bodies.inertia[k],     PeerJoint::ball,
               bodies.axis[k], bodies.rotation[k],   bodies.translation[k], bodies.q[k],
               bodies.qd[k],   torque_of(bodies, k), Vec3::zero(),          Vec3::zero()};
    if (pivots(bodies.joint[k])) b.joint = PeerJoint::revolute;
    if (!bodies.wrench.empty()) std::tie(b.wrench_torque, b.wrench_force) = bodies.wrench[k];
    if (floats(bodies.joint[k]))
        b.rotation = Mat3::identity(), b.translation = b.torque = Vec3::zero();
    return b;
}

/// Returns a body that slides along the ground's axes.
PeerBody slide_at(Vec3 const& position, Vec3 const& velocity, double mass) {
    PeerBody slide;
    slide.joint = PeerJoint::slide;
    slide.mass = mass;
    slide.translation = position;
    slide.qd = velocity;
    return slide;
}

void append(std::vector<double>& table, BodyArrays const& bodies) {
    if (floats(bodies.joint[0]))
        append(table, slide_at(bodies.free_base.position, bodies.free_base.velocity, 0));
    for (std::size_t k = 0; k < bodies.size(); ++k) append(table, body_of(bodies, k));
}

/// A link as a rod. The z axis of its frame points along the link; the frame does not rotate about
/// z relative to the previous rod.
struct Rod {
    double length = 0;
    /// Rotation matrix from the rod's axes to the ground's.
    Mat3 axes = Mat3::identity();
    /// Angular velocity in W.
    Vec3 omega = Vec3::zero();
    /// Rates of the universal joint about x and y.
    double u1 = 0, u2 = 0;

    Vec3 x() const { return axes.column(0); }
    Vec3 y() const { return axes.column(1); }
    Vec3 along() const { return axes.column(2); }
};

/// Returns a right-handed frame with z along a unit vector.
Mat3 axes_along(Vec3 const& z) {
    Vec3 const other = std::abs(z[0]) < 0.5 ? Vec3{{1, 0, 0}} : Vec3{{0, 1, 0}};
    Vec3 const across = cross(other, z), x = (1 / norm(across)) * across;
    Mat3 axes;
    axes.set_column(0, x);
    axes.set_column(1, cross(z, x));
    axes.set_column(2, z);
    return axes;
}

/// Returns the rod from bead k - 1 to bead k. `last` is the previous rod.
Rod rod_of(BeadArrays const& beads, std::size_t k, Rod const& last) {
    Rod rod;
    Vec3 const link = beads.position[k] - beads.position[k - 1];
    rod.length = norm(link);
    rod.axes = axes_along((1 / rod.length) * link);
    Vec3 const across =
        (1 / rod.length) * cross(rod.along(), beads.velocity[k] - beads.velocity[k - 1]);
    rod.u1 = dot(rod.x(), across - last.omega);
    rod.u2 = dot(rod.y(), across - last.omega);
    rod.omega = across + dot(rod.along(), last.omega) * rod.along();
    return rod;
}

void append(std::vector<double>& table, BeadArrays const& beads) {
    append(table, slide_at(beads.position[0], beads.velocity[0], beads.mass[0]));
    Rod last;
    for (std::size_t k = 1; k < beads.size(); ++k) {
        Rod const rod = rod_of(beads, k, last);
        PeerBody b;
        b.joint = PeerJoint::universal;
        b.mass = beads.mass[k];
        b.com = {{0, 0, rod.length}};
        b.rotation = transposed_times(last.axes, rod.axes);
        b.translation = {{0, 0, last.length}};
        b.qd = {{rod.u1, rod.u2, 0}};
        append(table, b);
        last = rod;
    }
}

/// Returns the accelerations of the beads from the first one on, from the joint accelerations of
/// the rods.
std::vector<double> accelerations_of_beads(BeadArrays const& beads,
                                           std::vector<double> const& found) {
    std::vector<double> list(found.begin(), found.begin() + 3);
    Vec3 acceleration{{found[0], found[1], found[2]}}, alpha = Vec3::zero();
    Rod last;
    for (std::size_t k = 1; k < beads.size(); ++k) {
        Rod const rod = rod_of(beads, k, last);
        Vec3 const relative = rod.u1 * rod.x() + rod.u2 * rod.y(), along = rod.length * rod.along();
        alpha = alpha + found[2 * k + 1] * rod.x() + found[2 * k + 2] * rod.y() +
                (rod.u1 * rod.u2) * rod.along() + cross(last.omega, relative);
        acceleration =
            acceleration + cross(alpha, along) + cross(rod.omega, cross(rod.omega, along));
        append(list, acceleration);
        last = rod;
    }
    return list;
}

/// True if the first body of the chain is free.
bool has_free_body(ChainSpec const& chain) {
    return !chain.is_beads() && floats(chain.bodies.joint[0]);
}

/// Returns the number of joint accelerations of a chain.
std::size_t accelerations_of(ChainSpec const& chain) {
    if (chain.is_beads()) return 1 + 2 * chain.size();
    std::size_t count = 0;
    for (JointType const joint : chain.bodies.joint)
        count += static_cast<std::size_t>(freedom_of(joint));
    return count;
}

}  // namespace

std::string not_for_peers(Scene const& scene) {
    auto const among = [](JointType joint) { return pivots(joint) || has_quaternion(joint); };
    std::string unknown;
    terms::for_each([&](auto term) {
        if (!term.known_to_peers && terms::acts_in<decltype(term)>(scene)) unknown = term.name;
    });
    if (scene.chains.size() != 1) return "not a single chain";
    if (!unknown.empty()) return "forces that they lack (" + unknown + ")";
    ChainSpec const& chain = scene.chains.front();
    if (chain.is_closed()) return "a closed chain";
    if (chain.is_linked()) return "beads and rigid bodies on links in one chain";
    if (scene::goes_by_paths(chain))
        return std::string("a ") + scene::kind_of_paths(chain) + " chain";
    if (chain.is_beads()) return chain.base == Base::free ? "" : "beads fixed to the ground";
    if (!std::all_of(chain.bodies.joint.begin(), chain.bodies.joint.end(), among))
        return "joints neither revolute nor spherical";
    return chain.bodies.driven.empty() ? "" : "driven joints";
}

std::vector<double> peer_table(ChainSpec const& chain, Vec3 const& gravity) {
    std::size_t const bodies = chain.size() + (has_free_body(chain) ? 1 : 0);
    std::vector<double> table{static_cast<double>(columns), static_cast<double>(bodies), gravity[0],
                              gravity[1], gravity[2]};
    table.reserve(columns * (bodies + 1));
    table.resize(columns, 0.0);
    if (chain.is_beads())
        append(table, chain.beads);
    else
        append(table, chain.bodies);
    return table;
}

std::vector<double> accelerations_of_peer(ChainSpec const& chain,
                                          std::vector<double> const& found) {
    if (found.size() != accelerations_of(chain)) return {};
    if (chain.is_beads()) return accelerations_of_beads(chain.beads, found);
    std::vector<double> list = found;
    if (has_free_body(chain))
        std::rotate(list.begin(), list.begin() + 3,
                    // The angular acceleration comes first in Catena's order.
                    list.begin() + 6);
    return list;
}

}  // namespace catena::command
