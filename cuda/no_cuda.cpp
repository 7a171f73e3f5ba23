// Stubs of the GPU interface for builds without CUDA. Functions that need a GPU throw
// ComputationError.
#include "cuda/device/clusters.hpp"
#include "cuda/device/gpu.hpp"
#include "cuda/dynamics.hpp"
#include "cuda/space/memory.hpp"
#include "error.hpp"
#include "neighbours/device_path.hpp"

namespace catena::cuda {

std::string const& why_not() {
    static std::string const reason = "built without CUDA";
    return reason;
}
std::string version() { return "none"; }
std::string device_name() { throw ComputationError(why_not()); }
int devices() { throw ComputationError(why_not()); }

std::string choose_device(Communicator const&) { return why_not(); }
int most_ranks_of_a_gpu(Communicator const&) { throw ComputationError(why_not()); }
std::int64_t free_memory(Communicator const&) { throw ComputationError(why_not()); }
bool knows_clusters() { throw ComputationError(why_not()); }
int multiprocessors() { throw ComputationError(why_not()); }
int blocks_at_once() { throw ComputationError(why_not()); }
std::int64_t stacks(std::int64_t) { throw ComputationError(why_not()); }
std::unique_ptr<dca::LevelPart> make_levels(ChainGroup const&, dca::LevelWork const&) {
    throw ComputationError(why_not());
}

std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const&, Scene const&,
                                                     Executor const&, Communicator const&) {
    throw ComputationError(why_not());
}
std::unique_ptr<AbsoluteDynamics> make_branched_dynamics(ChainGroup const&, Scene const&,
                                                         Executor const&, Communicator const&) {
    throw ComputationError(why_not());
}
std::unique_ptr<AbsoluteDynamics> make_rigid_dynamics(ChainGroup const&, Scene const&,
                                                      Executor const&, Communicator const&) {
    throw ComputationError(why_not());
}
std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const&, Scene const&, Executor const&,
                                                   Communicator const&) {
    throw ComputationError(why_not());
}

std::string const& why_no_device_path() { return why_not(); }
std::string why_pairs_cannot_be_shared() { return why_not(); }
bool gpus_are_alike(Communicator const&) { throw ComputationError(why_not()); }
bool gpus_may_write_to_each_other(Communicator const&) { throw ComputationError(why_not()); }
int chosen_device() { throw ComputationError(why_not()); }
std::unique_ptr<DevicePath> make_device_path(OpenMM::Context&, DevicePathPlan) {
    throw ComputationError(why_not());
}

}  // namespace catena::cuda
