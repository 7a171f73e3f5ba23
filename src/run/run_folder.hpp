// Output folder of a run. Rank 0 writes it; frames and checkpoints may be written by all ranks
// together. A failure (a full disk) ends all ranks in good order. Calls are therefore collective,
// except those that store a failure for check().
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "error.hpp"
#include "io/observables_table.hpp"
#include "io/output.hpp"
#include "observe/observables.hpp"
#include "run/run_lock.hpp"
#include "run/simulation.hpp"

namespace catena {

/// True if a run has written files there.
bool holds_run(std::string const& folder);

/// Files of a run, and the lock of its folder.
class RunFolder {
  public:
    /// Creates or opens the folder. Throws InputError on every rank.
    RunFolder(Scene const&, Communicator const&, RunOptions const&);

    /// Opens the files. `go_on`: step and records to continue from, if the folder is that of the
    /// checkpoint's run. Collective.
    void open(Topology const&, Observables const&, Continuation const& go_on);
    /// True if the topology's files are to be written: parts of the first state, then
    /// end_topology(). Failures are stored for check().
    bool wants_topology() const { return !appends_; }
    void put_topology(Frame const& part, Executor const&);
    void end_topology();
    /// Mode in which frames are written.
    ParallelIoMode const& frames_way() const { return frames_way_; }
    /// Writes a frame. In collective mode every rank calls these with its own parts. Otherwise
    /// begin() and put() act on rank 0 only, and failures are stored until the next check.
    void begin(std::int64_t step, double time);
    void put(std::span<Frame const> parts);
    void end(std::vector<Vector<double, 6>> const& tip_forces,
             std::vector<double> const& observables, std::vector<double> const& of_replicas);
    /// Stores a failure for check(), unless one is stored.
    void keep(std::exception_ptr failure) {
        if (!failure_) failure_ = std::move(failure);
    }
    /// Throws stored failures of the topology, and of frames that are not written together.
    /// Collective.
    void check();
    /// Number of frames in the trajectory, and of lines in the table, before step n. Rank 0 only.
    std::int64_t records_before(std::int64_t n) const;
    /// Writes a checkpoint together with the arrays of the bodies that ranks hold. Collective.
    void write_checkpoint(Checkpoint const&, ChainSystem const&, OwnState const&);
    /// Mode in which the last checkpoint was written.
    ParallelIoMode const& checkpoints_way() const { return checkpoints_way_; }
    /// Returns the table of observables as it stands in its file, with the frames of preceding
    /// runs. Empty on ranks other than 0. Collective.
    ObservablesTable table() { return read_table("observables.csv", observables_.get()); }
    /// Returns the table of the replicas, with the same lines; it has no columns without replicas.
    ObservablesTable table_of_replicas() { return read_table("replicas.csv", of_replicas_.get()); }
    /// Closes the tables and writes summary, timeline and report. Collective.
    void finish(std::string const& summary, std::string const& timeline);

    std::string path(std::string const& name) const { return folder_ + "/" + name; }

  private:
    /// Returns a table as it stands in its file; empty without a writer or a file. Collective.
    ObservablesTable read_table(char const* name, ObservablesWriter* writer);
    /// Applies `action` to the writers of tables.
    template <class Action>
    void each_table(Action const& action) {
        for (ObservablesWriter* const writer : {observables_.get(), of_replicas_.get()})
            if (writer) action(*writer);
    }
    /// Throws InputError if another run writes there, or files there would be lost.
    void refuse_unless_free(RunOptions const&) const;
    /// Returns the checkpoint with which a restart can begin; empty if there is none.
    std::string newest_checkpoint() const;
    /// Runs `action` and appends the advice of way_back() to a ComputationError.
    template <class Action>
    void telling_way_back(Action const& action);
    /// Runs `action` on rank 0 by telling_way_back(). Failures reach all ranks. Collective.
    template <class Action>
    void on_disk(Action const& action);
    /// Runs `action` on the ranks that write frames.
    template <class Action>
    void with_frames(Action const& action);
    /// Advice how to continue from the newest checkpoint; empty if there is none.
    std::string way_back() const;
    /// Runs `action` on rank 0 between collective calls and stores its failure. Does nothing after
    /// a stored failure.
    template <class Action>
    void keeping_failure(Action const& action);
    /// Throws ComputationError if a file of the run is gone.
    void require_files() const;
    /// Throws the stored failure, if there is one.
    void throw_kept();

    Scene const& scene_;
    Communicator const& communicator_;
    bool appends_ = false;  // the folder is that of the restart's checkpoint
    std::string folder_;
    std::unique_ptr<RunLock> lock_;  // exists on rank 0 only
    std::unique_ptr<TopologyWriter> topology_;
    ParallelIoMode frames_way_, checkpoints_way_;
    std::unique_ptr<TrajectoryWriter> trajectory_;
    std::unique_ptr<ObservablesWriter> observables_, of_replicas_;
    std::exception_ptr failure_;  // stored failure
    std::int64_t step_ = -1;      // step of the last frame that was begun here
    double time_ = 0;
};

/// Throws InputError if the arrays of a checkpoint exceed the process's limit of file sizes.
/// Collective.
void refuse_large_checkpoint(OwnState const&, Scene const&, Communicator const&,
                             std::string const& folder);

}  // namespace catena
