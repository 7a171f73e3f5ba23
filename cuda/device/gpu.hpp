// Selection and properties of the GPU that a rank uses, and construction of the pairwise tree's
// levels on it.
#pragma once

#include <memory>
#include <string>

#include "dca/level_solver.hpp"

namespace catena::cuda {

/// Returns an empty string if a GPU can be used, otherwise the reason ("built without CUDA" or
/// CUDA's own message). The driver is asked once per process; no context is created on the GPU.
std::string const& why_not();
/// Returns the CUDA version and the GPU: "13.0, NVIDIA H200", "13.0, no GPU can be used: ..." or
/// "none".
std::string version();
/// Returns the name of the present GPU, e.g. "NVIDIA H200". Precondition: there is a GPU.
std::string device_name();

/// Returns the number of GPUs that this process sees. Precondition: there is at least one.
int devices();

/// Makes GPU number (rank on the host) modulo (GPUs of the host) the current one of this thread.
/// Returns an empty string, or the reason why that GPU cannot be used (no kernels for it in this
/// build, CUDA's own message). Precondition: there is a GPU.
std::string choose_device(Communicator const&);
/// Returns the largest number of ranks that share one GPU. Precondition: every rank has chosen a
/// GPU. Collective.
int most_ranks_of_a_gpu(Communicator const&);

/// Returns the free memory of the GPU chosen last, bytes. If ranks of a host share that GPU, the
/// result is this rank's part.
std::int64_t free_memory(Communicator const&);

/// Returns the bytes that the driver reserves for stacks if each thread has `bytes_of_thread` bytes
/// of stack. The driver reserves them for all threads that fit on the GPU at once.
std::int64_t stacks(std::int64_t bytes_of_thread);

/// Makes a part of the pairwise tree's levels on the GPU chosen last (a dca::LevelPartMaker). That
/// GPU must be current in every thread that uses the part.
std::unique_ptr<dca::LevelPart> make_levels(ChainGroup const&, dca::LevelWork const&);

}  // namespace catena::cuda
