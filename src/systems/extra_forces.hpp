// Serialised forces that a scene adds to those of its builder or System. Needs OpenMM's headers.
#pragma once

#include "systems/bead_system.hpp"
#include "systems/import.hpp"
#include "systems/model.hpp"

namespace catena {

/// Adds the forces of the files ForceChanges::extra to the model, each in a group of its own. Their
/// particles are those of the model's System. Throws InputError for a file that holds no force, for
/// a thermostat or barostat, and for a force that does not fit the number of particles. Refused are
/// also a periodic force in a scene without a box, and more forces than OpenMM has groups.
void add_extra_forces(OpenMmModel& model, OpenMmSpec const&, BeadSystem const&);

}  // namespace catena
