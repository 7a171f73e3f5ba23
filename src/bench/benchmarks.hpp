// The benchmarks behind `catena bench`. All are collective; what they return counts on rank 0.
#pragma once

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "mpi/communicator.hpp"

namespace catena::command {

/// `solve`, or the list of benchmarks.
Outcome run_bench(Communicator const&, BenchRequest const&);
/// Forward dynamics by Pinocchio, Simbody and MuJoCo beside Catena's. One rank.
Outcome bench_peers(Communicator const&, BenchRequest);
/// Catena's steps beside OpenMM's own; what overlap brings. One rank.
Outcome bench_openmm(Communicator const&, BenchRequest const&);
Outcome bench_overlap(Communicator const&, BenchRequest const&);
/// What chains sample on rigid links, harmonic bonds and OpenMM's constraints at several steps, and
/// how fast. Writes its JSON after every row. One rank.
Outcome bench_sampling(Communicator const&, BenchRequest const&);
/// Messages between the ranks and the solver's own gathers, with the model that `plan --network`
/// reads.
Outcome bench_network(Communicator const&, BenchRequest const&);
/// Predictions and choices of the planner beside what is measured. One rank.
Outcome bench_plan(Communicator const&, BenchRequest const&);

}  // namespace catena::command
