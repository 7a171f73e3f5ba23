// OpenMM's forces on all beads of a scene, computed by one rank alone.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "force/openmm_force.hpp"
#include "math/field.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Evaluator of forces and energies outside a run, e.g. for checks and relaxation of a start.
class SingleRankForces {
  public:
    /// Uses OpenMM's platform Reference if the scene requests it, else CPU with a number of threads
    /// that does not depend on the cores. Forces are thus bitwise equal on any number of ranks.
    /// `reach`: cutoff of pair forces in nm (make_openmm_contacts()).
    explicit SingleRankForces(Scene const&, std::optional<double> reach = std::nullopt);

    /// Energy and forces at the same positions.
    struct EnergyAndForces {
        double energy = 0;         // kJ/mol; infinite if OpenMM's forces are not finite
        std::vector<Vec3> forces;  // kJ/mol/nm, in the order of beads(); those of forces() if
                                   // OpenMM's are not finite
    };
    /// Computes energy and forces at the positions, in nm and in the order of beads().
    EnergyAndForces at(std::vector<Vec3> const& positions);
    /// Returns forces in kJ/mol/nm, in the order of beads(). If OpenMM's are not finite, the result
    /// pushes beads nearer than 0.3 nm apart. If no beads are so near, it pushes every bead in a
    /// direction of its own. That bends straight chains, whose torsions are undefined.
    std::vector<Vec3> forces(std::vector<Vec3> const& positions);
    /// Returns the energy at the last positions, kJ/mol; infinite if forces were not finite. The
    /// call costs as much as forces().
    double energy();
    /// True if OpenMM's forces at the last positions were finite.
    bool are_finite() const { return finite_; }
    BeadSystem const& beads() const { return beads_; }

  private:
    /// Creates OpenMM's forces on this rank alone.
    std::unique_ptr<OpenMmForce> make(Scene const&, std::optional<double> reach);
    /// Substitute for forces that are not finite, as described at forces().
    std::vector<Vec3> pushes(std::vector<Vec3> const& positions) const;

    std::unique_ptr<Communicator> alone_;
    BeadSystem beads_;
    std::unique_ptr<OpenMmForce> force_;
    Field<3> position_, force_of_bead_;
    bool finite_ = true;
};

}  // namespace catena
