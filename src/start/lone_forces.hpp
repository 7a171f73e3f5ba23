// OpenMM's forces on all beads of a scene, computed by one rank for itself.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "force/openmm_force.hpp"
#include "math/field.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

class LoneForces {
  public:
    /// On OpenMM's platform Reference where the scene asks for it, else on CPU with a number of
    /// threads that does not depend on the cores: forces are the same bits on any number of ranks.
    /// `reach`: pair forces with a cutoff end there (make_openmm_contacts()).
    explicit LoneForces(Scene const&, std::optional<double> reach = std::nullopt);

    struct FusedSweep {
        double energy = 0;         // kJ/mol; infinite where forces are not finite
        std::vector<Vec3> forces;  // kJ/mol/nm, in the order of beads(); where OpenMM's are not
                                   // finite: as forces() says
    };
    FusedSweep at(std::vector<Vec3> const& positions);
    /// kJ/mol/nm, in the order of beads(). Where OpenMM's are not finite, they push apart what is
    /// nearer than 0.3 nm; where nothing is, they push every bead in a direction of its own, which
    /// bends what is straight: torsions of beads on a line are undefined.
    std::vector<Vec3> forces(std::vector<Vec3> const& positions);
    /// kJ/mol, at the positions given last; infinite where forces were not finite. As dear as
    /// forces().
    double energy();
    /// Whether OpenMM's forces at the positions given last were finite.
    bool are_finite() const { return finite_; }
    BeadSystem const& beads() const { return beads_; }

  private:
    std::unique_ptr<OpenMmForce> make(Scene const&, std::optional<double> reach);
    std::vector<Vec3> pushes(std::vector<Vec3> const& positions) const;

    std::unique_ptr<Communicator> alone_;
    BeadSystem beads_;
    std::unique_ptr<OpenMmForce> force_;
    Field<3> position_, force_of_bead_;
    bool finite_ = true;
};

}  // namespace catena
