// The benchmarks behind `catena bench`. All are collective; their outcomes are complete on rank 0
// only.
#pragma once

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "mpi/communicator.hpp"

namespace catena::command {

/// Runs the benchmark that the request names, or lists all benchmarks.
Outcome run_bench(Communicator const&, BenchRequest const&);
/// Compares forward dynamics with Pinocchio, Simbody and MuJoCo. One rank.
Outcome bench_peers(Communicator const&, BenchRequest);
/// Compares Catena's steps with those of OpenMM's own integrators. One rank.
Outcome bench_openmm(Communicator const&, BenchRequest const&);
/// Measures what overlapping the matrix sweep with the forces saves. One rank.
Outcome bench_overlap(Communicator const&, BenchRequest const&);
/// Measures what chains sample on rigid links, harmonic bonds and OpenMM's constraints at several
/// time steps, and how fast. Writes its JSON after every row. One rank.
Outcome bench_sampling(Communicator const&, BenchRequest const&);
/// Measures messages between ranks and the solver's own gathers. Its JSON holds the network model
/// that `plan --network` reads.
Outcome bench_network(Communicator const&, BenchRequest const&);
/// Compares predictions and choices of the planner with measured times. One rank.
Outcome bench_plan(Communicator const&, BenchRequest const&);

}  // namespace catena::command
