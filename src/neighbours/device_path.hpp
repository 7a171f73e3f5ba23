// OpenMM forces on beads that stay in GPU memory.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mpi/communicator.hpp"
#include "neighbours/device_beads.hpp"

namespace OpenMM {
class Context;
}

namespace catena {

/// Interval of time, in seconds of std::chrono::steady_clock.
struct Interval {
    double begin = 0, end = 0;
};

class Halo;

/// Forces on some of the particles of a path's Context, in a Context of their own.
struct DeviceLayer {
    OpenMM::Context* context = nullptr;  // shares the GPU context of the path's Context
    /// Particle of the path's Context that is the same bead as each particle of `context`.
    std::vector<int> particle;
    bool keeps_list = false;  // true if all its pair forces use the shared neighbour list
};

/// Options of a DevicePath.
struct DevicePathPlan {
    std::vector<int> particle;       // particle of each own bead
    std::vector<std::int64_t> bead;  // number of each own bead in messages
    /// Edges of the periodic box, nm. If set, particles may be moved by whole edges, one by one.
    std::optional<Vec3> box;
    bool shifted = false;     // true if all particles may be moved by one vector
    bool overlap = true;      // true if the chains' own work overlaps with OpenMM's
    bool keeps_list = false;  // true if all pair forces use the shared neighbour list
    Halo* halo = nullptr;     // null on a single rank
    /// Replica of each own bead; empty without replicas, which are kept farther apart than `reach`
    /// (nm, ReplicaPlaces).
    std::vector<std::int32_t> replica = {};
    double reach = 0;
    /// Layers whose forces are added to those of the path's Context. On several ranks, these share
    /// out pairs.
    std::vector<DeviceLayer> layers = {};
};

/// Evaluation of OpenMM forces for beads in GPU memory. Over several ranks begin(), go_on() and
/// refuse_trouble() are collective, and errors documented as ComputationError are SharedErrors.
class DevicePath {
  public:
    virtual ~DevicePath() = default;
    /// Makes OpenMM's GPU context current for this thread until the object's destruction; returns
    /// false if impossible. Chains must allocate their GPU memory in this context.
    virtual bool make_current() noexcept = 0;
    /// Enqueues OpenMM's work at the current positions; over several ranks, first the positions
    /// that other ranks need. `beads`: all groups of this rank in order, the same at every call.
    /// `timed`: clock() will be called. Throws OpenMM's exceptions, and ComputationError if the
    /// previous evaluation met a position or force that is not finite.
    virtual void begin(std::span<DeviceBeads* const> beads, bool timed) = 0;
    /// Ends the overlap: work enqueued to the beads' streams since begin() may run concurrently
    /// with what begin() and later calls enqueue. Over several ranks this call exchanges the
    /// ghosts' positions and then enqueues OpenMM's work.
    virtual void go_on(std::span<DeviceBeads* const> beads) = 0;
    /// Makes the beads' streams wait for OpenMM and then add its forces.
    virtual void finish(std::span<DeviceBeads* const> beads) = 0;
    /// Throws ComputationError if the last evaluation met a position or force that is not finite.
    /// Precondition: the beads' streams have completed.
    virtual void refuse_trouble() = 0;
    /// Times of the last evaluation, which must have been timed. `openmm`: OpenMM's computation.
    /// `chains`: the chains' work from begin() to go_on(). `exchange`: the exchange of ghosts, or
    /// the check of the neighbour list. Absent parts are 0. Waits for the GPU.
    struct Clock {
        Interval openmm, chains, exchange;
    };
    virtual Clock clock() = 0;
    /// Numbers of evaluations that built OpenMM's neighbour list, and of those that kept it without
    /// a check by OpenMM.
    struct PairLists {
        std::int64_t made = 0, kept = 0;
    };
    virtual PairLists pair_lists() const { return {}; }
    /// The same numbers for the Context of each layer.
    virtual std::vector<PairLists> pair_lists_of_layers() const { return {}; }
    /// Positions in the last evaluation, nm, W. Waits for the GPU.
    virtual std::vector<Vec3> positions() = 0;
};

/// Returns the path of a rank without beads, which only takes part in collective calls. `halo` must
/// outlive it.
std::unique_ptr<DevicePath> make_idle_path(Halo& halo, bool overlap);

namespace cuda {

/// Returns an empty string if this build can access OpenMM's arrays on a GPU of this machine, else
/// the reason why not.
std::string const& why_no_device_path();
/// Returns an empty string if a path can compute a share of a Context's pairs and keep their
/// neighbour list, else the reason why not. Precondition: why_no_device_path() is empty.
std::string why_pairs_cannot_be_shared();
/// True if the GPUs of all ranks are of one model, so that OpenMM orders particles and blocks
/// alike. Collective.
bool gpus_are_alike(Communicator const&);
/// True if the ranks' GPUs can write to each other's memory. Collective.
bool gpus_may_write_to_each_other(Communicator const&);
/// Index of the GPU that choose_device() selected.
int chosen_device();
/// Returns the path for `context`, which must be of OpenMM's CUDA platform and outlive it.
/// Precondition: why_no_device_path() is empty.
std::unique_ptr<DevicePath> make_device_path(OpenMM::Context& context, DevicePathPlan plan);

}  // namespace cuda
}  // namespace catena
