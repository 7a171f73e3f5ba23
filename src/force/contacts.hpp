// OpenMM's forces between near beads alone: cheap to compute, and all that matters where beads
// overlap.
#pragma once

#include <memory>

#include "force/openmm_force.hpp"

namespace catena {

/// make_openmm_force() with pair forces that have a cutoff switched off between 0.8 `reach` and
/// `reach` (nm), where they reach farther. Bonded forces, and pair forces without a cutoff or with
/// a mesh, stay as they are.
std::unique_ptr<OpenMmForce> make_openmm_contacts(OpenMmSpec const&, BeadSystem const&,
                                                  Communicator const&, double reach);

}  // namespace catena
