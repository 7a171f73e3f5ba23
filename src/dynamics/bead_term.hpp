// Force terms that act on single beads of a group in absolute coordinates, on the host.
#pragma once

#include "dca/solver.hpp"
#include "dynamics/body_loads.hpp"

namespace catena {

/// Force and energy of one term.
class BeadTerm {
  public:
    virtual ~BeadTerm() = default;
    /// Adds its force on each bead (W) at the configuration of the last assembled matrices.
    /// Collective.
    virtual void add_forces(ConfigurationView const&, View<3> force) = 0;
    /// Sets its energy by bead from the last add_forces(), kJ/mol, unless the beads' positions
    /// suffice (ForceTerm::energy_of()).
    virtual void set_energy(PotentialEnergy&) const {}
};

}  // namespace catena
