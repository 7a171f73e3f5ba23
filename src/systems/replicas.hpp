// Replicas in OpenMM: the System of one replica, repeated. Needs OpenMM's headers.
#pragma once

#include "systems/bead_system.hpp"
#include "systems/model.hpp"

namespace catena {

/// Returns the beads of the first replica, whose chains have their names in the scene file.
BeadSystem first_replica(BeadSystem const&);

/// Returns the beads of this rank's replicas, as those of a single rank. Throws InputError unless
/// every rank has the same number of whole replicas.
BeadSystem replicas_of_rank(BeadSystem const&, int rank, int ranks);

/// Repeats the model of one replica. Particles and terms of a replica follow those of the one
/// before, and no force joins two replicas if these are farther apart than all cutoffs. Throws
/// InputError for forces that know places, are periodic, have no cutoff, or are of a kind that
/// cannot be repeated.
void repeat_model(OpenMmModel& model, BeadSystem const& one, std::int64_t replicas);

}  // namespace catena
