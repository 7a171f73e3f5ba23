// Implements the draw of thermal velocities in absolute coordinates.
#include "start/start_velocities.hpp"

#include <algorithm>

#include "integrate/chain_system.hpp"
#include "integrate/stepper.hpp"
#include "mpi/collectives.hpp"
#include "scene/branch_limits.hpp"
#include "scene/freedom.hpp"

namespace catena {
namespace {

bool is_thermal(ChainSpec const& chain) { return chain.velocities == StartVelocities::thermal; }
bool has_absolute_coordinates(ChainSpec const& chain) {
    return !chain.has_loops() && !scene::is_body_tree(chain) &&
           !scene::joint_without_absolute_coordinates(chain);
}

/// State in absolute coordinates of every body of the scene, on every rank.
struct Drawn {
    std::vector<double> velocity, omega,
        orientation;  // W; body axes; quaternions of the body axes in W
    Vec3 velocity_of(std::size_t body) const {
        return {{velocity[3 * body], velocity[3 * body + 1], velocity[3 * body + 2]}};
    }
    Vec3 omega_of(std::size_t body) const {
        return {{omega[3 * body], omega[3 * body + 1], omega[3 * body + 2]}};
    }
    /// Rotation matrix from body axes to W.
    Mat3 rotation_of(std::size_t body) const {
        double const* const q = orientation.data() + 4 * body;
        return to_matrix(Quat{q[0], q[1], q[2], q[3]});
    }
};

/// Draws velocities by a stepper in absolute coordinates and distributes them to all ranks.
/// Collective.
Drawn draw(Scene const& scene, DynamicsSpec dynamics, Communicator const& communicator) {
    ChainSystem system(scene, Axes::world, communicator);
    dynamics.integrator =
        Integrator::rattle;  // any integrator in absolute coordinates draws velocities at its start
    make_stepper(system, dynamics);
    auto arrays = system.state();
    auto const n = static_cast<std::size_t>(scene.bodies());
    auto const shared = [&](char const* name, std::size_t width) {
        std::vector<double> values = arrays[name];  // absent if the scene has only beads
        values.resize(n * width);
        broadcast(communicator, values);
        return values;
    };
    return {shared("velocity", 3), shared("omega", 3), shared("orientation", 4)};
}

/// Stores drawn velocities in a chain, as rates relative to the inboard body for spherical joints.
void set_velocities(ChainSpec& chain, Drawn const& drawn, std::size_t first) {
    chain.velocities = StartVelocities::given;
    for (std::size_t k = 0; k < chain.beads.size(); ++k)
        chain.beads.velocity[k] = drawn.velocity_of(first + k);
    for (std::size_t k = 0; k < chain.linked.size(); ++k) {
        chain.linked.velocity[k] = drawn.velocity_of(first + k);
        chain.linked.omega[k] = drawn.omega_of(first + k);
    }
    BodyArrays& bodies = chain.bodies;
    bodies.qd.resize(bodies.size(), Vec3::zero());
    for (std::size_t k = 0; k < bodies.size(); ++k) {  // relative to the inboard body, body axes
        bodies.qd[k] = drawn.omega_of(first + k);
        if (k > 0)
            bodies.qd[k] = bodies.qd[k] - transposed_times(drawn.rotation_of(first + k),
                                                           drawn.rotation_of(first + k - 1) *
                                                               drawn.omega_of(first + k - 1));
    }
    if (bodies.size() > 0 && chain.base == Base::free)
        bodies.free_base.velocity =
            drawn.velocity_of(first) -
            drawn.rotation_of(first) * cross(drawn.omega_of(first), bodies.com[0]);
}

}  // namespace

Scene with_start_velocities(Scene scene, Communicator const& communicator) {
    if (std::none_of(scene.chains.begin(), scene.chains.end(), is_thermal)) return scene;
    Scene sampled = scene;
    sampled.forces.openmm.reset();
    std::erase_if(sampled.chains, [](ChainSpec const& c) {
        return !has_absolute_coordinates(c);
    });  // chains without absolute coordinates are never thermal
    Drawn const drawn = draw(sampled, scene.dynamics, communicator);
    std::size_t body = 0;
    for (ChainSpec& chain : scene.chains) {
        if (!has_absolute_coordinates(chain)) continue;
        if (is_thermal(chain)) set_velocities(chain, drawn, body);
        body += chain.size();
    }
    return scene;
}

}  // namespace catena
