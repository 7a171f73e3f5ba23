// Forces of replicas that are dealt out to ranks: each rank computes its own ones alone.
#pragma once

#include <memory>

#include "force/openmm_force.hpp"

namespace catena {

/// Returns forces that each rank computes on whole replicas without messages. Only energies are
/// summed over the ranks, in their order. `own`: the forces on this rank's replicas, made for the
/// single rank `alone`.
std::unique_ptr<OpenMmForce> replicas_of_ranks(std::unique_ptr<Communicator> alone,
                                               std::unique_ptr<OpenMmForce> own,
                                               Communicator const& all);

}  // namespace catena
