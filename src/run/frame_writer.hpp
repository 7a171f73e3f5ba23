// Frames of a run: observation of the state and writing of trajectory, topology and observables,
// also concurrently with the steps that follow.
#pragma once

#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "observe/observables.hpp"
#include "observe/run_verdict.hpp"
#include "observe/sites.hpp"
#include "run/run_folder.hpp"
#include "run/run_origin.hpp"

namespace catena {

/// Writes the frames of a run to its folder, and passes them to the verdict. All functions except
/// those marked otherwise are collective.
class FrameWriter {
  public:
    /// The run whose frames are written. All parts outlive the writer.
    struct Source {
        Scene const& scene;
        Communicator const& communicator;
        RunOptions const& options;
        RunOrigin const& origin;
        ChainSystem& system;
        Stepper& stepper;
        RunVerdict& verdict;
    };
    /// `sites`: all sites on rank 0, none on other ranks.
    FrameWriter(Source const&, Sites sites);

    /// Observes the state at the first step, calls `look` and opens the files. Precondition: forces
    /// have been computed. They exist before anything is written or replaced.
    void open(std::function<void()> const& look);
    /// Writes the frame of step n. If there are many bodies, a separate thread of rank 0 writes it
    /// after the ranks have sent their parts; a single rank's thread also writes a topology that is
    /// due. Steps continue until something else must be written.
    void write(std::int64_t n, double constraint_error);
    /// Forgets the observation of the first step. Not collective.
    void leave_start() { at_start_.reset(); }
    /// Ends a concurrent write that has finished, and throws its failure.
    void poll();
    /// Waits for the frame that is being written, if there is one. Throws its failure.
    void finish();

    /// True if the frame of step n remains as the preceding run wrote it. Not collective.
    bool is_kept(std::int64_t n) const;
    RunFolder& folder() { return *folder_; }
    /// Returns the topology, whose lists are empty on ranks that write no files.
    Topology const& topology() const { return sites_.topology(); }
    /// Returns names and values of the last frame's observables. Rank 0 only.
    std::vector<std::string> const& columns() const { return observables_->columns(); }
    std::vector<double> const& last_row() const { return last_row_; }
    /// Returns the number of frames that were written concurrently with steps.
    std::int64_t frames_beside() const { return frames_beside_; }
    /// Returns the wall time of each part of the frames, s. Precondition: no frame is being
    /// written.
    std::map<std::string, double> const& seconds() const { return seconds_; }

  private:
    /// Largest number of bodies whose rows are gathered on rank 0 and kept between frames.
    static constexpr std::int64_t most_bodies_kept = 20'000'000;
    /// Observations at a step.
    struct Observed {
        std::vector<EnergyTerm> terms;
        std::optional<OwnBodies> bodies = std::nullopt;  // computed on demand
    };
    /// Frame that is being written.
    struct PendingFrame {
        std::int64_t step;
        double error;
        Observed now;
        std::vector<Vector<double, 6>> at_tips;
        std::optional<AllBodies> all = std::nullopt;  // if ranks have sent their parts
    };
    /// Computes what observers need. `anyway`: forces are computed even if nothing requests them.
    Observed observed(bool anyway = false);
    OwnBodies own_bodies();
    /// Writes the topology files from the bodies at the first step.
    void write_topology(OwnBodies const& at_start);
    /// True if frames may be written concurrently with steps.
    bool may_write_beside() const;
    /// Gathers the pending frame on rank 0. Collective.
    void gather();
    /// Writes the pending frame in a thread of its own and adds its wall time to `writing`. Returns
    /// false if no thread can be created.
    bool write_beside(double& writing);
    /// Writes the pending frame. The folder stores a failure for the next check.
    void write_keeping_failure();
    /// Writes a frame. A single rank sends no messages.
    void write(PendingFrame const&);
    /// Computes a frame's row of observables and passes its energies to the verdict. Rank 0 only.
    void judge(PendingFrame const&);
    /// Writes this rank's own bodies of a frame in collective mode.
    void put_own(OwnBodies const&);

    Source run_;
    Sites sites_;
    std::unique_ptr<RunFolder> folder_;
    std::unique_ptr<Observables> observables_;
    std::vector<double> last_row_;      // last frame
    std::optional<Observed> at_start_;  // data for the topology and the first frame
    bool topology_is_due_ = false;      // topology files are written with the first frame
    std::int64_t frames_beside_ = 0;
    std::map<std::string, double> seconds_;
    /// Rows of a frame that has been written, for the next one.
    std::vector<std::vector<double>> spare_;
    std::vector<double> spare_of_all_;
    bool is_beside_ = false;  // on every rank: finish() has not yet ended the pending frame
    std::optional<PendingFrame> pending_;
    std::future<void> frame_;  // last member: it ends before the members that it uses
};

}  // namespace catena
