// An evaluation of OpenMM's forces on the beads of a system.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "force/openmm_force.hpp"
#include "kinematics/carried_beads.hpp"

namespace catena {

/// Seconds of the phases of evaluations so far.
struct EvaluationTimes {
    /// "kinematics and loads", "matrix sweep", "bias sweep", "forces", "waiting for forces",
    /// "exchange".
    std::map<std::string, double> seconds;
    /// Seconds of matrix sweeps, and of those during which OpenMM computed on other resources.
    double matrices = 0, hidden = 0;
};

/// Passes the positions of beads to OpenMM and its forces to the beads.
class OpenMmEvaluation {
  public:
    /// `groups`: those that are beads or carry some. `is_absolute`: whether a group has absolute
    /// coordinates. Must be called before anything of the chains is on a GPU: if OpenMM computes
    /// there, they live in its context. Throws InputError without beads. Collective.
    OpenMmEvaluation(Scene const&, Communicator const&, std::vector<ChainGroup const*> groups,
                     ChainsOnDevice const&);
    /// Finds the dynamics that hold the positions of beads.
    void find_hosts(std::vector<BeadHost*> const& dynamics);

    OpenMmForce& force() const { return *force_; }
    /// The scene's beads as OpenMM sees them.
    BeadSystem const& beads() const { return beads_; }
    /// Makes the GPU context current. Returns false on failure.
    bool make_current() noexcept;
    /// True if OpenMM reads the beads' positions on the GPU.
    bool on_device() const { return !device_beads_.empty(); }

    /// Starts the forces at the present positions; `timed`: the GPU's clock will be read.
    /// Collective.
    void begin(bool timed, EvaluationTimes&);
    /// Path `device`: continues after the matrix sweep was enqueued. Collective.
    void go_on();
    /// Waits for the forces and adds them to the beads.
    void finish();
    /// Path `device`: reads the GPU's clock and adds up the seconds of the phases.
    DevicePath::Clock read_clock(EvaluationTimes&);
    /// Forces on own beads at the last evaluation, in the order of BeadSystem::by_rank, kJ/mol/nm,
    /// W. Path `device`: computes them again.
    std::vector<Vec3> own_forces();
    /// Messages of this rank that carried positions to OpenMM.
    Traffic traffic() const { return traffic_; }

  private:
    /// Sets the owners of beads.
    void order_by_rank(Scene const&);
    /// Copies the positions of own beads, in the order of BeadSystem::by_rank.
    ConstView<3> own_positions();

    Communicator const& communicator_;
    /// Groups that are beads or carry some, in the order of hosts_.
    std::vector<ChainGroup const*> groups_;
    BeadSystem beads_;
    std::unique_ptr<OpenMmForce> force_;
    std::vector<BeadHost*> hosts_;
    /// Entries of hosts_ whose beads OpenMM reads on a GPU; else empty.
    std::vector<DeviceBeads*> device_beads_;
    /// Positions (nm) and forces (kJ/mol/nm) of own beads at the last evaluation, W, host after
    /// host.
    Field<3> own_position_, own_force_;
    Traffic traffic_;
    // The GPU's clock is read at every eighth evaluation only, because reading it takes time.
    static constexpr std::int64_t evaluations_a_clock = 8;
    bool clock_is_due_ = false, timed_before_ = false;
    std::int64_t evaluations_since_clock_ = 0;
};

}  // namespace catena
