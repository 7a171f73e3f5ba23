// Where a run begins: at the scene's start, at a checkpoint that it continues, or at another run's
// checkpoint from which it branches.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "integrate/stepper.hpp"
#include "io/output.hpp"
#include "observe/run_verdict.hpp"
#include "run/simulation.hpp"
#include "terms/deciding.hpp"

namespace catena {

/// Beginning of a run. Steps and time count from the scene's start, also over restarts and
/// branches.
class RunOrigin {
  public:
    /// Reads the checkpoint, if the options name one, and shares it with every rank, without its
    /// notes and arrays of bodies. Throws InputError for a checkpoint of another scene. Collective.
    RunOrigin(Scene const&, Communicator const&, RunOptions const&);

    /// True if the run begins at a checkpoint.
    bool is_restart() const { return !options_.restart.empty(); }
    /// Returns the ranks' shares of the bodies that the checkpoint holds; empty if it holds none.
    std::vector<double> shares() const;

    /// Parts of a run whose state a checkpoint holds, and the list to which notes are added.
    struct Parts {
        ChainSystem& system;
        Stepper& stepper;
        RunVerdict& verdict;
        SweepWatch& watch;
        std::vector<std::string>& notes;
    };
    /// Restores the state of the checkpoint, if there is one. Throws InputError if the run would
    /// end before it begins. Collective.
    void restore(Parts const&);
    /// Adds all that a restart needs except frames, shares and the bodies' arrays. Precondition:
    /// the checkpoint has its step.
    void save(Checkpoint&, Parts const&) const;

    /// Returns the run's first and last step.
    std::int64_t first_step() const { return first_; }
    std::int64_t last_step() const { return last_; }
    /// Returns the time at step n, ps (s with `units: si`).
    double time(std::int64_t n) const {
        return time_origin_ + static_cast<double>(n) * scene_.dynamics.step;
    }
    /// True if step n has a frame, which depends on the step alone and not on where a run ends. A
    /// branch begins with a frame.
    bool is_frame(std::int64_t n) const {
        return n % scene_.output.every == 0 || (options_.branch && n == first_);
    }
    /// Returns the step from which existing files are continued. The frame of the checkpoint's step
    /// is written again, or remains as that run's, or is removed. The latter is the frame of a run
    /// that ended there, which the uninterrupted run would not have written.
    Continuation go_on() const {
        return {is_frame(first_) || !was_frame_ ? first_ - 1 : first_, records_before_};
    }
    /// Returns the object "branch" of summary.json; null for a run that is no branch.
    nlohmann::json branch_json() const;

  private:
    Checkpoint read();
    /// Restores the state of a branch. Time continues from its value, whatever the length of a
    /// step.
    void branch(Checkpoint, Parts const&);
    void continue_run(Checkpoint const&, Parts const&);
    /// Sets the last step of a branch, or of a restart of one, unless --steps is set. It lies as
    /// many steps after the branch's beginning as the scene states.
    void count_from_branch(std::int64_t step);

    Scene const& scene_;
    Communicator const& communicator_;
    RunOptions const& options_;
    std::int64_t first_ = 0, last_;
    std::vector<scene::ChangedValue> changes_;  // changes of a branch, on rank 0
    std::optional<Checkpoint> from_;            // exists until it is restored
    std::optional<std::int64_t>
        branched_at_;         // step at which the branch began, also after its restart
    double time_origin_ = 0;  // time at step 0
    std::int64_t records_before_ =
        0;  // smallest number of frames that the preceding run left before the checkpoint's step
    bool was_frame_ = true;  // the checkpoint's step was a frame, not only that run's last state
    std::map<std::string, std::string> values_of_scene_;  // for checkpoints, rank 0 only
};

// Names in checkpoints that several parts of a run share.
inline constexpr char const *number_of_records = "records_before", *whether_frame = "frame_at_step",
                            *array_of_shares = "rank_shares";

}  // namespace catena
