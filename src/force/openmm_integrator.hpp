// OpenMmIntegrator: OpenMM integrates a scene's beads by itself, so that its speed and its samples
// can be compared with Catena's.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena {

/// OpenMM's representation of the scene's links: stiff harmonic bonds or constraints.
enum class OwnLinks { bonds, constraints };

/// Parameters of the integration by OpenMM.
struct OwnRun {
    double step = 0.01, temperature = 300, friction = 0.01;  // ps, K, 1/ps
    std::uint64_t seed = 1;
    int device = -1;  // GPU; -1: none, and the platform is CPU unless the scene names one
};

/// Returns the largest relative deviation of a link from its length; NaN if a position is NaN. `x`:
/// positions of all beads, nm.
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

/// A Langevin integration of all beads of a scene by OpenMM, on this rank.
class OpenMmIntegrator {
  public:
    virtual ~OpenMmIntegrator() = default;
    /// Advances by `steps` time steps and waits until they are done.
    virtual void step(int steps) = 0;
    /// Returns the potential energy of all forces, bonds included, kJ/mol.
    virtual double energy() = 0;
    /// Returns the kinetic energy, kJ/mol, of the velocities as the integrator stores them.
    virtual double kinetic_energy() = 0;
    /// Returns the positions of all beads in BeadSystem's order, nm, W, unwrapped. Throws what
    /// OpenMM throws if they are not finite.
    virtual std::vector<Vec3> positions() = 0;
    /// Returns catena::link_error() of the present positions.
    virtual double link_error() = 0;
    /// Name of OpenMM's platform.
    virtual std::string platform() const = 0;
};

/// Makes OpenMM's LangevinMiddleIntegrator for the CALVADOS 2 model, with bonds of 8033 kJ/mol/nm2
/// or rigid links. It starts at `positions` (nm, W) with thermal velocities. Throws what OpenMM
/// throws, and "built without OpenMM" in a build without it.
std::unique_ptr<OpenMmIntegrator> make_openmm_integrator(OpenMmSpec const&, BeadSystem const&,
                                                         Communicator const&, OwnLinks,
                                                         OwnRun const&,
                                                         std::vector<Vec3> const& positions);

}  // namespace catena
