// OpenMM's forces on beads that stay on the GPU.
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

/// When something ran, in seconds of std::chrono::steady_clock.
struct Interval {
    double begin = 0, end = 0;
};

class Halo;

struct DevicePathPlan {
    std::vector<int> particle;       // of each own bead
    std::vector<std::int64_t> bead;  // its number among all, for messages
    std::optional<Vec3> box;         // particles may be moved by its edges, one by one
    bool shifted = false;            // all particles may be moved by one vector
    bool overlap = true;             // the chains' own work goes on while OpenMM computes
    bool keeps_list = false;         // no force looks for pairs but by the list that all share
    Halo* halo = nullptr;            // of a rank among several
};

/// Over several ranks begin(), go_on(), refuse_trouble() are collective, and what is said to be a
/// ComputationError there is a SharedError.
class DevicePath {
  public:
    virtual ~DevicePath() = default;
    /// Makes the GPU context that OpenMM computes in that of this thread, or says false: what the
    /// chains keep on the GPU must be made there. Until the object's end.
    virtual bool make_current() noexcept = 0;
    /// Enqueues OpenMM's work at the beads' positions; over several ranks what others must be shown
    /// of them. `beads`: all of this rank, group after group, the same every time. `timed`: clock()
    /// will be asked about it. Throws what OpenMM throws, and ComputationError where the beads of
    /// the evaluation before had no finite position or force.
    virtual void begin(std::span<DeviceBeads* const> beads, bool timed) = 0;
    /// What the beads' streams were given since begin() may run side by side with what begin()
    /// enqueued and with what follows: here it ends. Over several ranks positions of ghosts come
    /// now, and OpenMM's work is enqueued.
    virtual void go_on(std::span<DeviceBeads* const> beads) = 0;
    /// Lets the beads' streams wait for OpenMM and add its forces.
    virtual void finish(std::span<DeviceBeads* const> beads) = 0;
    /// Throws ComputationError where beads of the last evaluation had no finite position or force.
    /// To be asked once their streams have been waited for.
    virtual void refuse_trouble() = 0;
    /// Of the last evaluation, which was timed: OpenMM's computation, the chains' work from begin()
    /// to go_on(), and what brought ghosts, or told whether pairs' list still holds; 0 where there
    /// was no such thing. Waits for them.
    struct Clock {
        Interval openmm, chains, exchange;
    };
    virtual Clock clock() = 0;
    /// At how many evaluations OpenMM's list of pairs was made, and at how many it was kept without
    /// OpenMM being asked.
    struct PairLists {
        std::int64_t made = 0, kept = 0;
    };
    virtual PairLists pair_lists() const { return {}; }
    /// Of the last evaluation's beads, as they are now, nm, W. Waits for them.
    virtual std::vector<Vec3> positions() = 0;
};

/// Of a rank among several that has no beads: it takes part in what all do. `halo` must outlive it.
std::unique_ptr<DevicePath> make_idle_path(Halo& halo, bool overlap);

namespace cuda {

/// Empty where OpenMM's arrays can be reached on a GPU by this build and on this machine, else why
/// not.
std::string const& why_no_device_path();
/// Empty where such a path can compute some of the pairs of a Context alone, and can keep their
/// list, else why not. Precondition: why_no_device_path() is empty.
std::string why_pairs_cannot_be_shared();
/// Whether the ranks' GPUs are of one kind, so that they find the same order of particles and
/// blocks. Collective.
bool gpus_are_alike(Communicator const&);
/// Whether the ranks' GPUs may write to each other's memory. Collective.
bool gpus_may_write_to_each_other(Communicator const&);
/// The GPU that choose_device chose.
int chosen_device();
/// `context`: of OpenMM's CUDA platform; must outlive it. Precondition: why_no_device_path() is
/// empty.
std::unique_ptr<DevicePath> make_device_path(OpenMM::Context& context, DevicePathPlan plan);

}  // namespace cuda
}  // namespace catena
