// The folder a run writes, on rank 0; frames and checkpoints may be all ranks' together. What fails
// there (a full disk) ends all ranks in good order: calls are collective, but for those that keep
// what fails for check().
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "error.hpp"
#include "io/output.hpp"
#include "observe/observables.hpp"
#include "run/run_lock.hpp"
#include "run/simulation.hpp"

namespace catena {

/// Whether a run has written there.
bool holds_run(std::string const& folder);

class RunFolder {
  public:
    /// Makes or opens the folder. Throws InputError on every rank.
    RunFolder(Scene const&, Communicator const&, RunOptions const&);

    /// `go_on`: in the files of the checkpoint's run, where the folder is that run's.
    void open(Topology const&, std::vector<std::string> const& columns, Continuation const& go_on);
    /// Whether the topology's files are wanted: the first state's parts, and the end of it. What
    /// fails there is kept for check().
    bool wants_topology() const { return !appends_; }
    void put_topology(Frame const& part, Executor const&);
    void end_topology();
    /// How frames are written.
    ParallelIoMode const& frames_way() const { return frames_way_; }
    /// A frame: collective, each rank with parts of its own; else begin and parts on rank 0 alone,
    /// which keeps what fails there for the end.
    void begin(std::int64_t step, double time);
    void put(std::span<Frame const> parts);
    void end(std::vector<Vector<double, 6>> const& tip_forces,
             std::vector<double> const& observables);
    /// Throws what was kept of failures: of the topology, and of frames that are not written
    /// together. Collective.
    void check();
    /// Frames in the trajectory, and lines in the table, before step n; for rank 0.
    std::int64_t records_before(std::int64_t n) const;
    /// With the arrays of bodies that ranks have of the system.
    void write_checkpoint(Checkpoint const&, ChainSystem const&, ChainSystem::OwnState const&);
    /// How the last one was written.
    ParallelIoMode const& checkpoints_way() const { return checkpoints_way_; }
    /// Closes the tables, writes summary, timeline and report.
    void finish(std::string const& summary, std::string const& timeline);

    std::string path(std::string const& name) const { return folder_ + "/" + name; }

  private:
    /// InputError where another run writes there, or what is there would be lost.
    void refuse_unless_free(RunOptions const&) const;
    /// What a restart can begin with; empty: nothing.
    std::string newest_checkpoint() const;
    /// A ComputationError of the action's tells the way back as well.
    template <class Action>
    void telling_way_back(Action const& action);
    /// The same by rank 0, for all.
    template <class Action>
    void on_disk(Action const& action);
    /// By whoever writes frames.
    template <class Action>
    void with_frames(Action const& action);
    std::string way_back() const;
    /// On rank 0 between collective calls, unless something failed before.
    template <class Action>
    void keeping_failure(Action const& action);
    void throw_kept();

    Scene const& scene_;
    Communicator const& communicator_;
    bool appends_ = false;
    std::string folder_;
    std::unique_ptr<RunLock> lock_;  // on rank 0
    std::unique_ptr<TopologyWriter> topology_;
    ParallelIoMode frames_way_, checkpoints_way_;
    std::unique_ptr<TrajectoryWriter> trajectory_;
    std::unique_ptr<ObservablesWriter> observables_;
    std::exception_ptr failure_;
    std::int64_t step_ = -1;  // of the last frame that was begun here
    double time_ = 0;
};

}  // namespace catena
