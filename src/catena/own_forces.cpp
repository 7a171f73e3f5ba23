// Own forces: points that rigid bodies carry, and forces on them.
#include "catena/own_forces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/content.hpp"
#include "dynamics/body_loads.hpp"
#include "error.hpp"

namespace catena {
namespace {

char const* const own_force = "own force";
/// Number of points of a rigid body.
constexpr std::int64_t points_of_body = 4;

/// Adds the points of a body: its centre of mass (from the origin of positions, B) and a point on
/// each axis, as far as the radius of gyration.
void add_points(CarriedBeads& carried, Vec3 const& com, Sym3 const& inertia, double mass) {
    double const arm = radius_of_gyration(inertia, mass);
    carried.position.push_back(com);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 place = com;
        place[axis] += arm;
        carried.position.push_back(place);
    }
}

/// Completes the other lists after the points of a body were added.
void close_body(CarriedBeads& carried) {
    carried.offset.push_back(static_cast<std::int64_t>(carried.position.size()));
    carried.mass.resize(carried.position.size(), 1.0);
    carried.residue.resize(carried.position.size(), "UNK");
}

CarriedBeads points_of(BodyArrays const& bodies) {
    CarriedBeads carried;
    carried.offset = {0};
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        add_points(carried, bodies.com[k], bodies.inertia[k], bodies.mass[k]);
        close_body(carried);
    }
    return carried;
}
/// A bead carries itself.
CarriedBeads points_of(LinkedArrays const& linked) {
    CarriedBeads carried;
    carried.offset = {0};
    for (std::size_t k = 0; k < linked.size(); ++k) {
        if (linked.is_bead(k))
            carried.position.push_back(Vec3::zero());
        else
            add_points(carried, Vec3::zero(), linked.inertia[k], linked.mass[k]);
        close_body(carried);
    }
    return carried;
}

/// Points of body k of a group: the first one, and their number.
std::pair<std::int64_t, std::int64_t> points_of(ChainGroup const& group, std::int64_t k) {
    if (group.beads) return {k, 1};
    auto const i = static_cast<std::size_t>(k);
    return {group.carried.offset[i], group.carried.offset[i + 1] - group.carried.offset[i]};
}

/// Distance of the point on an axis from the centre of mass, given the body's first point.
double arm_of(ChainGroup const& group, std::int64_t first, int axis) {
    return group.carried.place[static_cast<std::size_t>(first + 1 + axis)][axis];
}

/// Body axes in W, from the positions of a body's points.
Mat3 axes_of_points(ChainGroup const& group, ConstView<3> points, std::int64_t first) {
    Mat3 axes;
    for (int i = 0; i < 3; ++i)
        axes.set_column(
            i, (1 / arm_of(group, first, i)) * (points.load(first + 1 + i) - points.load(first)));
    return axes;
}

bool is_zero(Triple const& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }
bool is_finite(Triple const& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}
Vec3 as_vec(Triple const& v) { return {{v[0], v[1], v[2]}}; }

void add_to(View<3> forces, std::int64_t k, Vec3 const& force) {
    forces.store(k, forces.load(k) + force);
}

/// Adds a torque (W) as couples of forces: e2 on the point of axis e1 turns about e3, and so on.
void add_couples(ChainGroup const& group, View<3> forces, std::int64_t first, Mat3 const& axes,
                 Vec3 const& torque) {
    Vec3 const in_body = transposed_times(axes, torque);
    for (int i = 0; i < 3; ++i) {
        double const size = in_body[(i + 2) % 3] / arm_of(group, first, i);
        Vec3 const force = size * axes.column((i + 1) % 3);
        add_to(forces, first + 1 + i, force);
        add_to(forces, first, -force);
    }
}

}  // namespace

void refuse_own_forces_on_gpu(Scene const& scene) {
    if (uses_gpu(scene.solver.backend))
        throw InputError(
            "own forces are computed on the host",
            own_force + (": solver.backend " + std::string(name_of(scene.solver.backend))),
            "use auto, segments, openmp or serial");
}

Scene with_force_points(Scene scene) {
    refuse_own_forces_on_gpu(scene);
    for (ChainSpec& chain : scene.chains) {
        if (chain.is_beads()) continue;
        if (scene.forces.openmm)
            throw InputError(
                "own forces on rigid bodies and forces of OpenMM exclude each other",
                own_force + (": chain `" + chain.name + "`"),
                "add the force to OpenMM (forces.openmm.extra), or use chains of beads alone");
        chain.bodies.carried = chain.bodies.size() > 0 ? points_of(chain.bodies) : CarriedBeads{};
        chain.linked.carried = chain.is_linked() ? points_of(chain.linked) : CarriedBeads{};
    }
    return scene;
}

OwnForces::OwnForces(OwnForce force, ChainSystem& system) : force_(std::move(force)) {
    for (AbsoluteDynamics* const group : system.absolute()) hosts_.push_back(group);
    for (JointDynamics* const group : system.joint()) hosts_.push_back(group);
    auto const bodies = static_cast<std::size_t>(system.scene().bodies());
    position_.resize(bodies);
    on_force_.resize(bodies);
    on_torque_.resize(bodies);
    orientation_.resize(bodies, {1, 0, 0, 0});
    system.add_forces_by([this] { add(); });
}

void OwnForces::add() {
    for (BeadHost* const host : hosts_) read(*host);
    std::fill(on_force_.begin(), on_force_.end(), Triple{});
    std::fill(on_torque_.begin(), on_torque_.end(), Triple{});
    energy_ = force_({position_, orientation_}, {on_force_, on_torque_});
    for (std::size_t k = 0; k < on_force_.size(); ++k)
        if (!is_finite(on_force_[k]) || !is_finite(on_torque_[k]))
            throw ComputationError("the own force on body " + std::to_string(k + 1) +
                                   " of the scene is not finite");
    for (BeadHost* const host : hosts_) write(*host);
}

void OwnForces::read(BeadHost& host) {
    ChainGroup const& group = host.group();
    ConstView<3> const points = host.bead_positions();
    for (std::int64_t k = 0; k < group.size; ++k) {
        auto const body = static_cast<std::size_t>(group.scene_index(k));
        auto const [first, count] = points_of(group, k);
        position_[body] = as_triple(points.load(first));
        if (count == points_of_body)
            orientation_[body] =
                as_unit_quaternion(to_quaternion(axes_of_points(group, points, first)));
    }
}

void OwnForces::write(BeadHost& host) {
    ChainGroup const& group = host.group();
    ConstView<3> const points = host.bead_positions();
    View<3> const forces = host.bead_forces();
    for (std::int64_t k = 0; k < group.size; ++k) {
        auto const body = static_cast<std::size_t>(group.scene_index(k));
        auto const [first, count] = points_of(group, k);
        add_to(forces, first, as_vec(on_force_[body]));
        if (is_zero(on_torque_[body])) continue;
        if (count != points_of_body)
            throw InputError("a bead takes no torque",
                             own_force + (": body " + std::to_string(body + 1) + " of the scene"),
                             "set forces on beads alone");
        add_couples(group, forces, first, axes_of_points(group, points, first),
                    as_vec(on_torque_[body]));
    }
}

}  // namespace catena
