// OpenMM's forces on all beads of a scene, computed by one rank for itself.
#pragma once

#include <memory>
#include <vector>

#include "chain/field.hpp"
#include "force/openmm_force.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

class LoneForces {
  public:
    /// On OpenMM's platform Reference where the scene asks for it, else on CPU with a number of threads that does not depend on the cores:
    /// forces are the same bits on any number of ranks.
    explicit LoneForces(Scene const&);

    struct Evaluation {
        double energy = 0;  // kJ/mol; infinite where forces are not finite
        std::vector<Vec3>
            forces;  // kJ/mol/nm, in the order of beads(); where OpenMM's are not finite: they push apart what is nearer than 0.3 nm
    };
    Evaluation at(std::vector<Vec3> const& positions);
    BeadSystem const& beads() const { return beads_; }

  private:
    std::unique_ptr<OpenMmForce> make(Scene const&);
    std::vector<Vec3> pushes(std::vector<Vec3> const& positions) const;

    std::unique_ptr<Communicator> alone_;
    BeadSystem beads_;
    std::unique_ptr<OpenMmForce> force_;
    Field<3> position_;
};

}  // namespace catena
