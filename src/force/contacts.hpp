// OpenMM's short-range forces alone: they cost little and are all that matters where beads overlap.
#pragma once

#include <memory>

#include "force/openmm_force.hpp"

namespace OpenMM {
class System;
}

namespace catena {

/// Makes the forces of make_openmm_force() with shortened pair forces. Pair forces whose cutoff
/// exceeds `reach` (nm) are switched off between 0.8 `reach` and `reach`. Bonded forces, and pair
/// forces without a cutoff or with a mesh, are unchanged. Throws what make_openmm_force() throws.
/// Collective.
std::unique_ptr<OpenMmForce> make_openmm_contacts(OpenMmSpec const&, BeadSystem const&,
                                                  Communicator const&, double reach);

/// Shortens the cutoff of pair forces to at most `reach` (nm), switched off from 0.8 `reach` on.
void shorten_pair_forces(OpenMM::System&, double reach);

}  // namespace catena
