// OpenMM integrating a scene's beads by itself, to be timed and sampled beside Catena.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena {

/// What stands for the scene's links.
enum class OwnLinks { bonds, constraints };

struct OwnRun {
    double step = 0.01, temperature = 300, friction = 0.01;  // ps, K, 1/ps
    std::uint64_t seed = 1;
    int device = -1;  // the GPU; -1: none, the platform is CPU unless the scene names one
};

/// Largest deviation of a link from its length, relative; NaN where a position is. `x`: of all
/// beads.
inline double link_error(std::vector<BeadSystem::Link> const& links, std::vector<Vec3> const& x) {
    double worst = 0;
    for (auto const& link : links) {
        double const length = norm(x[static_cast<std::size_t>(link.outboard)] -
                                   x[static_cast<std::size_t>(link.inboard)]);
        double const error = std::abs(length - link.length) / link.length;
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

class OpenMmIntegrator {
  public:
    virtual ~OpenMmIntegrator() = default;
    /// Takes so many steps, and waits for them.
    virtual void step(int steps) = 0;
    /// kJ/mol, all forces and the bonds.
    virtual double energy() = 0;
    /// kJ/mol, of the velocities as the integrator keeps them.
    virtual double kinetic_energy() = 0;
    /// Of the beads in BeadSystem's order, nm, W, unwrapped. Throws what OpenMM throws where they
    /// are not finite.
    virtual std::vector<Vec3> positions() = 0;
    /// catena::link_error of these.
    virtual double link_error() = 0;
    virtual std::string platform() const = 0;
};

/// LangevinMiddleIntegrator on the CALVADOS 2 model with bonds of 8033 kJ/mol/nm2 or rigid links,
/// from `positions` (nm, W) with thermal velocities. Throws what OpenMM throws, and "built without
/// OpenMM".
std::unique_ptr<OpenMmIntegrator> make_openmm_integrator(OpenMmSpec const&, BeadSystem const&,
                                                         Communicator const&, OwnLinks,
                                                         OwnRun const&,
                                                         std::vector<Vec3> const& positions);

}  // namespace catena
