// The tree solver on a GPU, behind the host's interface: configuration and loads go up, accelerations and forces come back.
#pragma once

#include <memory>
#include <string>

#include "dca/solver.hpp"

namespace catena::cuda {

/// Empty where a GPU can be used, else why not ("built without CUDA", CUDA's own words, no kernels for this GPU). Asks once.
std::string const& why_not();
/// "13.0, NVIDIA H200", "13.0, no GPU can be used: ..." or "none".
std::string version();
/// "NVIDIA H200". Precondition: a GPU can be used.
std::string device_name();

/// From here on this rank uses the host's GPU number (rank on the host) modulo (GPUs). Precondition: a GPU can be used.
void choose_device(Communicator const&);

/// The same tree and the same operations as make_tree_solver's. Precondition: a GPU can be used, and one is chosen.
std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const&, Communicator const&);

}  // namespace catena::cuda
