#include "command/peer_chain.hpp"

#include <array>
#include <cmath>
#include <tuple>

#include "dca/rotation.hpp"

namespace catena::command {
namespace {

enum class PeerJoint { revolute, ball, slide, universal };

struct PeerBody {
    double mass = 0;
    Vec3 com = Vec3::zero();
    Sym3 inertia = Sym3::zero();
    PeerJoint joint = PeerJoint::revolute;
    Vec3 axis = Vec3::zero();
    Mat3 rotation = Mat3::identity();
    Vec3 translation = Vec3::zero();
    std::array<double, 4> q{0, 0, 0, 0};
    Vec3 qd = Vec3::zero(), torque = Vec3::zero(), wrench_torque = Vec3::zero(), wrench_force = Vec3::zero();
};
constexpr std::size_t columns = 42;

void append(std::vector<double>& table, Vec3 const& v) { table.insert(table.end(), v.data, v.data + 3); }

void append(std::vector<double>& table, PeerBody const& b) {
    table.push_back(b.mass);
    append(table, b.com);
    for (auto const& [i, j] : {std::pair{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}) table.push_back(b.inertia(i, j));
    table.push_back(static_cast<double>(b.joint));
    append(table, b.axis);
    table.insert(table.end(), b.rotation.data, b.rotation.data + 9);
    append(table, b.translation);
    table.insert(table.end(), b.q.begin(), b.q.end());
    for (Vec3 const& v : {b.qd, b.torque, b.wrench_torque, b.wrench_force}) append(table, v);
}

PeerBody body_of(BodyArrays const& bodies, std::size_t k) {
    auto const or_zero = [k](std::vector<Vec3> const& list) { return list.empty() ? Vec3::zero() : list[k]; };
    PeerBody b{bodies.mass[k],        bodies.com[k], bodies.inertia[k], PeerJoint::ball,        bodies.axis[k], bodies.rotation[k],
               bodies.translation[k], bodies.q[k],   bodies.qd[k],      or_zero(bodies.torque), Vec3::zero(),   Vec3::zero()};
    if (bodies.joint[k] == JointType::revolute) b.joint = PeerJoint::revolute;
    if (!bodies.wrench.empty()) std::tie(b.wrench_torque, b.wrench_force) = bodies.wrench[k];
    return b;
}

/// A link as a rod: axes with z along it, at rest about z against the rod before.
struct Rod {
    double length = 0;
    Mat3 axes = Mat3::identity();  // in the ground's
    Vec3 omega = Vec3::zero();     // W
    double u1 = 0, u2 = 0;         // rates of the universal joint about x and y

    Vec3 x() const { return axes.column(0); }
    Vec3 y() const { return axes.column(1); }
    Vec3 along() const { return axes.column(2); }
};

/// A right-handed frame with z along a unit vector.
Mat3 axes_along(Vec3 const& z) {
    Vec3 const other = std::abs(z[0]) < 0.5 ? Vec3{{1, 0, 0}} : Vec3{{0, 1, 0}};
    Vec3 const across = cross(other, z), x = (1 / norm(across)) * across;
    Mat3 axes;
    axes.set_column(0, x);
    axes.set_column(1, cross(z, x));
    axes.set_column(2, z);
    return axes;
}

/// From bead k - 1 to bead k; `last`: the one before.
Rod rod_of(BeadArrays const& beads, std::size_t k, Rod const& last) {
    Rod rod;
    Vec3 const link = beads.position[k] - beads.position[k - 1];
    rod.length = norm(link);
    rod.axes = axes_along((1 / rod.length) * link);
    Vec3 const across = (1 / rod.length) * cross(rod.along(), beads.velocity[k] - beads.velocity[k - 1]);
    rod.u1 = dot(rod.x(), across - last.omega);
    rod.u2 = dot(rod.y(), across - last.omega);
    rod.omega = across + dot(rod.along(), last.omega) * rod.along();
    return rod;
}

void append(std::vector<double>& table, BeadArrays const& beads) {
    PeerBody first;
    first.joint = PeerJoint::slide;
    first.mass = beads.mass[0];
    first.translation = beads.position[0];
    first.qd = beads.velocity[0];
    append(table, first);
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

/// Second derivatives along the rods, from the first bead on.
std::vector<double> accelerations_of_beads(BeadArrays const& beads, std::vector<double> const& found) {
    std::vector<double> list(found.begin(), found.begin() + 3);
    Vec3 acceleration{{found[0], found[1], found[2]}}, alpha = Vec3::zero();
    Rod last;
    for (std::size_t k = 1; k < beads.size(); ++k) {
        Rod const rod = rod_of(beads, k, last);
        Vec3 const relative = rod.u1 * rod.x() + rod.u2 * rod.y(), along = rod.length * rod.along();
        alpha =
            alpha + found[2 * k + 1] * rod.x() + found[2 * k + 2] * rod.y() + (rod.u1 * rod.u2) * rod.along() + cross(last.omega, relative);
        acceleration = acceleration + cross(alpha, along) + cross(rod.omega, cross(rod.omega, along));
        append(list, acceleration);
        last = rod;
    }
    return list;
}

std::size_t accelerations_of(ChainSpec const& chain) {
    if (chain.is_beads()) return 1 + 2 * chain.size();
    std::size_t count = 0;
    for (JointType const joint : chain.bodies.joint) count += joint == JointType::revolute ? 1 : 3;
    return count;
}

}  // namespace

std::vector<double> peer_table(ChainSpec const& chain, Vec3 const& gravity) {
    std::vector<double> table{static_cast<double>(columns), static_cast<double>(chain.size()), gravity[0], gravity[1], gravity[2]};
    table.reserve(columns * (chain.size() + 1));
    table.resize(columns, 0.0);
    if (chain.is_beads()) {
        append(table, chain.beads);
        return table;
    }
    for (std::size_t k = 0; k < chain.size(); ++k) append(table, body_of(chain.bodies, k));
    return table;
}

std::vector<double> accelerations_of_peer(ChainSpec const& chain, std::vector<double> const& found) {
    if (found.size() != accelerations_of(chain)) return {};
    return chain.is_beads() ? accelerations_of_beads(chain.beads, found) : found;
}

}  // namespace catena::command
