// Collects the loads of local bodies from the scene.
#include "dynamics/body_loads.hpp"

#include <algorithm>

#include "joints/joint_models.hpp"

namespace catena {
namespace {

bool any(std::vector<Vec3> const& values) {
    return std::any_of(values.begin(), values.end(),
                       [](Vec3 const& v) { return v[0] != 0 || v[1] != 0 || v[2] != 0; });
}

/// Copies one array of the scene for every local body.
template <int D, class Get>
Field<D> field_of(ChainGroup const& group, Scene const& scene, Get const& get) {
    Field<D> field(group.size);
    for (dca::Piece const& piece : group.pieces)
        for (std::int64_t i = 0; i < piece.count; ++i)
            field.set(piece.local + i,
                      get(scene.chains[group.chain[piece.chain]].bodies, piece.body + i));
    return field;
}

/// Entry i of an optional array; zero if the array is empty.
Vec3 entry(std::vector<Vec3> const& values, std::int64_t i) {
    return values.empty() ? Vec3::zero() : values[i];
}

/// Adds drag: a chain's own values, else the scene's.
void add_drag(ChainGroup const& group, Scene const& scene, BodyLoads& loads) {
    std::array<double, 2> const everywhere{scene.forces.linear_drag, scene.forces.angular_drag};
    loads.dragged = everywhere[0] > 0 || everywhere[1] > 0;
    for (int const chain : group.chain)
        for (auto const& d : scene.chains[chain].bodies.drag)
            loads.dragged = loads.dragged || d[0] > 0 || d[1] > 0;
    if (!loads.dragged) return;
    loads.drag = field_of<2>(group, scene, [&](BodyArrays const& b, std::int64_t i) {
        std::array<double, 2> const d = b.drag.empty() ? everywhere : b.drag[i];
        return Vector<double, 2>{{d[0], d[1]}};
    });
}

}  // namespace

BodyLoads make_body_loads(ChainGroup const& group, Scene const& scene) {
    BodyLoads loads;
    loads.gravity = scene.forces.gravity;
    if (group.linked) return loads;  // Bodies on links have gravity and the forces on their beads.
    for (int const chain : group.chain) {
        BodyArrays const& b = scene.chains[chain].bodies;
        loads.springs = loads.springs || any(b.stiffness);
        loads.dampers = loads.dampers || any(b.damping);
        loads.joint_loads = loads.joint_loads || any(b.torque);
        loads.wrenches =
            loads.wrenches || std::any_of(b.wrench.begin(), b.wrench.end(), [](auto const& w) {
                return any(std::vector<Vec3>{w.first, w.second});
            });
    }
    loads.joint_loads = loads.joint_loads || loads.springs || loads.dampers;
    add_drag(group, scene, loads);
    if (loads.joint_loads)
        loads.torque = field_of<3>(
            group, scene, [](BodyArrays const& b, std::int64_t i) { return entry(b.torque, i); });
    if (loads.springs) {
        loads.stiffness = field_of<3>(group, scene, [](BodyArrays const& b, std::int64_t i) {
            return entry(b.stiffness, i);
        });
        loads.rest = field_of<4>(group, scene, [](BodyArrays const& b, std::int64_t i) {
            if (!b.rest.empty())
                return Vector<double, 4>{{b.rest[i][0], b.rest[i][1], b.rest[i][2], b.rest[i][3]}};
            return Vector<double, 4>{{is_ball(b.joint[i]) ? 1.0 : 0.0, 0, 0, 0}};
        });
    }
    if (loads.dampers)
        loads.damping = field_of<3>(
            group, scene, [](BodyArrays const& b, std::int64_t i) { return entry(b.damping, i); });
    if (loads.wrenches) {
        loads.wrench_torque = field_of<3>(group, scene, [](BodyArrays const& b, std::int64_t i) {
            return b.wrench.empty() ? Vec3::zero() : b.wrench[i].first;
        });
        loads.wrench_force = field_of<3>(group, scene, [](BodyArrays const& b, std::int64_t i) {
            return b.wrench.empty() ? Vec3::zero() : b.wrench[i].second;
        });
    }
    return loads;
}

double spherical_spring_energy(Vec3 const& stiffness, Quat const& rest, Quat const& rotation) {
    Vec3 const theta = rotation_vector(conjugate(rest) * rotation);
    return 0.5 * (stiffness[0] * theta[0] * theta[0] + stiffness[1] * theta[1] * theta[1] +
                  stiffness[2] * theta[2] * theta[2]);
}

}  // namespace catena
