// The GPU that a rank uses, and the pairwise tree's levels there.
#pragma once

#include <memory>
#include <string>

#include "dca/level_solver.hpp"

namespace catena::cuda {

/// Empty where there is a GPU, else why not ("built without CUDA", CUDA's own words). Asks once,
/// and leaves the GPU alone.
std::string const& why_not();
/// "13.0, NVIDIA H200", "13.0, no GPU can be used: ..." or "none".
std::string version();
/// "NVIDIA H200". Precondition: there is a GPU.
std::string device_name();

/// How many GPUs this process sees. Precondition: there is one.
int devices();

/// From here on this thread uses the host's GPU number (rank on the host) modulo (GPUs). Empty, or
/// why that GPU cannot be used (no kernels for it in this build, CUDA's own words). Precondition:
/// there is a GPU.
std::string choose_device(Communicator const&);
/// Most ranks that use one GPU together. Precondition: every rank has chosen one. Collective.
int most_ranks_of_a_gpu(Communicator const&);

/// Bytes that are free on the GPU chosen last, or this rank's part of them where ranks of a host
/// share it.
std::int64_t free_memory(Communicator const&);

/// What the driver keeps on the GPU chosen last where a kernel's threads have so many bytes of
/// stack each: of all that fit on it at once.
std::int64_t stacks(std::int64_t bytes_of_thread);

/// A part of the pairwise tree's levels on the GPU chosen last (a dca::LevelPartMaker), which must
/// be current in every thread that uses it.
std::unique_ptr<dca::LevelPart> make_levels(ChainGroup const&, dca::LevelWork const&);

}  // namespace catena::cuda
