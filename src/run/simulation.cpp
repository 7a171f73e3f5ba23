// Implements runs: the loop over time steps.
#include "run/simulation.hpp"

#include <cmath>
#include <future>
#include <nlohmann/json.hpp>
#include <utility>

#include "cuda/device/gpu.hpp"
#include "error.hpp"
#include "integrate/checked_steps.hpp"
#include "integrate/step_failure.hpp"
#include "mpi/first_rank.hpp"
#include "run/frame_writer.hpp"
#include "run/message_count.hpp"
#include "run/pace.hpp"
#include "run/rank_exchange.hpp"
#include "run/run_origin.hpp"
#include "run/run_summary.hpp"
#include "start/start_velocities.hpp"

namespace catena {
namespace {

/// Timelines of the first few steps and then of those that write output, up to a limit.
class KeptTimelines {
  public:
    static constexpr std::int64_t first_steps = 5;
    /// Returns the timeline to be filled for step n; null if it is not `wanted` or beyond the
    /// limit.
    StepTimeline* of_step(std::int64_t n, bool wanted) {
        if (!wanted || timelines_.size() >= most) return nullptr;
        timelines_.reserve(most);
        timelines_.push_back({n, {}});
        return &timelines_.back();
    }
    std::vector<StepTimeline> const& all() const { return timelines_; }

  private:
    static constexpr std::size_t most = 50;
    std::vector<StepTimeline> timelines_;
};

/// Requests of this rank to save or to stop, on which ranks agree (StopAgreement).
class Requests {
  public:
    /// Value of a request to save; one to stop has the reason to stop added.
    static constexpr int save = 1;
    /// `stop`: see RunOptions. `minutes`: time between checkpoints, 0 if this rank asks for none.
    Requests(StopAgreement::Wish const& stop, double minutes) : stop_(stop), minutes_(minutes) {}
    /// Returns the request to stop, else that to save because of the time, else 0.
    int now() const {
        if (int const stop = stop_ ? stop_() : 0; stop != 0) return save + stop;
        return minutes_ > 0 && seconds_now() - saved_at_ >= 60 * minutes_ ? save : 0;
    }
    /// Begins to count the time until the next checkpoint.
    void note_checkpoint() { saved_at_ = seconds_now(); }

  private:
    StopAgreement::Wish const& stop_;
    double minutes_, saved_at_ = 0;
};

/// Adds a warning if several ranks use one GPU. Collective.
void warn_of_shared_gpus(ChainSystem const& system, Communicator const& communicator,
                         std::vector<std::string>& notes) {
    if (!uses_gpu(system.backend()) || communicator.size() == 1) return;
    int const ranks = cuda::most_ranks_of_a_gpu(communicator);
    if (ranks > 1)
        notes.push_back("warning: " + std::to_string(ranks) +
                        " ranks share a GPU, where each waits for the others: start one rank per "
                        "GPU");
}

/// Adds notes about output options without effect. `without_bodies`: no chain has rigid bodies.
void note_outputs(OutputSpec const& output, RunOrigin const& origin, bool without_bodies,
                  std::vector<std::string>& notes) {
    std::int64_t const every = output.every, first = origin.first_step(), last = origin.last_step();
    if (last > first && every > last - first && (last - 1) / every == first / every)
        notes.push_back("output.every = " + std::to_string(every) + " exceeds the " +
                        std::to_string(last - first) +
                        " steps of this run: no frame lies between its first and last states");
    if (output.coordinates && without_bodies)
        notes.push_back(
            "output.coordinates: no chain has rigid bodies, so there are no coordinates to write");
}

/// State of one run on one rank.
class Run {
  public:
    Run(Scene const& scene, Communicator const& communicator, RunOptions const& options,
        std::optional<StartRelaxation> relaxation)
        : scene_(scene),
          communicator_(communicator),
          options_(options),
          root_(communicator.rank() == 0),
          axes_(uses_joint_coordinates(scene_.dynamics.integrator) ? Axes::joint : Axes::world),
          implicit_step_(is_implicit(scene_.dynamics.integrator) ? scene_.dynamics.step : 0.0),
          origin_(scene_, communicator_, options_),
          shares_(shares()),
          sites_of_scene_(root_ ? std::async([this] { return Sites(scene_); })
                                : std::future<Sites>()),
          system_(scene_, axes_, communicator, implicit_step_, shares_.shares),
          stepper_(stepper_of_scene()),
          messages_(scene_, communicator_, system_),
          frames_({scene_, communicator_, options_, origin_, system_, *stepper_, verdict_},
                  root_ ? sites_of_scene_.get() : Sites()) {
        record_.notes = scene_.notes;
        record_.start = {scene_.start, std::nullopt, std::move(relaxation)};
        warn_of_shared_gpus(system_, communicator_, record_.notes);
    }

    /// Runs all steps and returns the summary. Collective.
    nlohmann::ordered_json run() {
        origin_.restore(parts());
        std::int64_t const first = origin_.first_step(), last = origin_.last_step();
        note_outputs(scene_.output, origin_, root_ && frames_.topology().bodies.empty(),
                     record_.notes);
        Progress progress(options_.quiet || !root_, first, last, scene_.dynamics.step, scene_.si);
        double const start = seconds_now();
        std::int64_t const rounds = communicator_.rounds();
        StopAgreement agreement(communicator_, [this] { return requests_.now(); }, first);
        requests_.note_checkpoint();
        std::int64_t n = first;
        while (!ends_at(n, agreement)) {
            progress.update(++n);
            pace_.note(n, first + (last - first + 1) / 2, seconds_now());
        }
        progress.finish();
        record_.seconds = seconds_now() - start;
        record_.rounds = communicator_.rounds() - rounds;
        record_.rate_of_second_half = pace_.steps_per_second();
        return finish();
    }

  private:
    /// Prepares step n, writes what is due there, and advances to step n + 1. Returns true, without
    /// advancing, if the run ends there. Collective.
    bool ends_at(std::int64_t n, StopAgreement& agreement) {
        frames_.poll();  // reports a failure of the concurrent write
        std::int64_t const first = origin_.first_step(), last = origin_.last_step();
        bool const writes = origin_.is_frame(n);
        bool const saves = scene_.output.checkpoint_every > 0 &&
                           n % scene_.output.checkpoint_every == 0 && n > first;
        bool const looks = writes || saves || is_checked(n);
        StepTimeline* const timeline =
            timelines_.of_step(n, n - first < KeptTimelines::first_steps || writes);
        bool const renews = (saves || n == last) && system_.openmm();
        if (renews) system_.openmm()->renew_ghosts();  // same ghosts as after a restart from here
        Traffic const before = messages_.so_far();
        bool const mended = !prepare(n, timeline);
        Traffic of_step = messages_.so_far() - before;
        if (n == first) open();  // forces exist before anything is written or replaced
        int const agreed = n == last ? 0 : agreement.reason_at(n);
        bool const saves_by_time = agreed == Requests::save;
        record_.stopped_by = std::max(0, agreed - Requests::save);
        bool const ends = n == last || record_.stopped_by != 0;
        // A state is checked before it is saved: steps that left joints open cannot be repeated
        // after a restart.
        double const error = looks || saves_by_time || ends || n == first ? look(n) : 0;
        // A check due to the clock counts only if its result makes the run worthless.
        if (looks || error > scene_.dynamics.constraint_tolerance) verdict_.note_error(n, error);
        if (looks) adapt(n, error);
        if (writes) frames_.write(n, error);
        if (!ends) frames_.leave_start();
        if (saves || saves_by_time || ends) checkpoint(n);
        if (ends) {
            end(n, error, writes);
            return true;
        }
        Traffic const prepared = messages_.so_far();
        at_step(n, true, [&] { stepper_->step(n, timeline); });
        of_step += messages_.so_far() - prepared;
        stepper_->note_error(n);
        if (n > first && !renews && !mended)
            messages_.add(of_step, *stepper_);  // repeated steps may evaluate once more
        if (n == first) {
            system_.wait();
            record_.first_step_after = seconds_now() - options_.begun;
        }
        return false;
    }

    /// Writes the last state. Its frame follows the checkpoint: a restart from there equals the
    /// uninterrupted run, which lacks this frame.
    void end(std::int64_t n, double error, bool is_written) {
        if (!is_written && !frames_.is_kept(n)) frames_.write(n, error);
        frames_.finish();
        record_.reached = n;
        verdict_.note_end(n, error);
    }

    /// Makes the stepper. Throws InputError if the scene asks for refinement that the integrator
    /// does not have. Collective.
    std::unique_ptr<Stepper> stepper_of_scene() {
        refuse_refinement(scene_);
        return make_stepper(system_, scene_.dynamics);
    }

    /// Returns the shares of the ranks: those of the checkpoint if as many ranks made it, else
    /// measured ones. Collective.
    RankShares shares() {
        if (!scene_.solver.balance || communicator_.size() == 1) return {};
        return rank_shares(communicator_, origin_.shares(), [this] {
            return options_.own_costs(scene_, axes_, communicator_, implicit_step_);
        });
    }

    RunOrigin::Parts parts() { return {system_, *stepper_, verdict_, watch_, record_.notes}; }

    /// Opens the output at the first step, after its forces have been computed. Collective.
    void open() {
        OwnState own = CheckpointParts(system_).own_state();
        stepper_->save(own);
        refuse_large_checkpoint(own, scene_, communicator_, options_.output);
        frames_.open([this] {
            if (system_.openmm() && !origin_.is_restart())
                record_.start.forces = look_at_start(system_);
        });
    }

    /// Largest constraint error over all ranks, so that every rank decides alike. Throws if the
    /// state is not finite.
    double look(std::int64_t n) {
        double const error = stepper_->look(n);
        if (!std::isfinite(error))
            throw SharedError("the state is not finite at step " + std::to_string(n) +
                              ": choose a smaller dynamics.step, or look at the start");
        return error;
    }

    /// Adds a projection sweep if one is due. It does so only at steps that the scene determines,
    /// not where a run happens to end: a restart must equal the uninterrupted run.
    void adapt(std::int64_t n, double error) {
        if (n == origin_.first_step() && origin_.is_restart()) return;  // the preceding run did it
        if (stepper_->adapt(watch_, error, scene_.dynamics.constraint_tolerance))
            record_.notes.push_back("one more projection sweep from step " + std::to_string(n) +
                                    " on");
    }

    /// Runs `action` and adds step n to its failures. `has_started`: n is not the scene's start.
    template <class Action>
    void at_step(std::int64_t n, bool has_started, Action const& action) {
        try {
            action();
        } catch (SharedError const& error) {
            throw SharedError(failure_in_step(n, error.what(), scene_, has_started));
        } catch (ComputationError const& error) {
            throw ComputationError(failure_in_step(n, error.what(), scene_, has_started));
        }
    }

    /// Computes forces and matrices. If forces fail because a step tore joints open, that step is
    /// repeated. The run ends if only one rank knows of the failure. Returns true if nothing was
    /// repeated.
    bool prepare(std::int64_t n, StepTimeline* timeline) {
        try {
            at_step(n, n > 0, [&] { stepper_->prepare(timeline); });
            return true;
        } catch (SharedError const&) {
            if (!stepper_->mend(n)) throw;
        } catch (ComputationError const&) {
            if (communicator_.size() > 1 || !stepper_->mend(n)) throw;
        }
        return false;
    }

    /// Writes a checkpoint of the state at step n. Collective.
    void checkpoint(std::int64_t n) {
        frames_.finish();
        Checkpoint c;
        c.step = n;
        origin_.save(c, parts());
        bool const is_kept = frames_.is_kept(n);
        c.integers[number_of_records] = frames_.folder().records_before(n) - (is_kept ? 1 : 0);
        c.integers[whether_frame] = origin_.is_frame(n) || is_kept ? 1 : 0;
        if (!shares_.shares.empty())
            c.arrays[array_of_shares] = {shares_.shares.begin(), shares_.shares.end()};
        OwnState own = CheckpointParts(system_).own_state();
        stepper_->save(own);
        frames_.folder().write_checkpoint(c, system_, own);
        requests_.note_checkpoint();
    }

    /// Judges the run, writes the final files and returns the summary. Collective.
    nlohmann::ordered_json finish() {
        std::vector<RunCheck> const found = root_ ? verdict_.checks() : std::vector<RunCheck>();
        bool const valid = communicator_.sum(all_passed(found) ? 0 : 1) == 0;
        for (RunCheck const& check : found)
            if (check.passed && !check.advice.empty()) record_.notes.push_back(check.advice);
        if (std::string const note = stepper_->note_of_sweeps(); !note.empty())
            record_.notes.push_back(note);
        nlohmann::ordered_json const summary =
            summary_of_run({scene_, communicator_, options_, origin_, system_, *stepper_, frames_,
                            verdict_, shares_, messages_, record_},
                           valid, found);
        nlohmann::json const timeline = gather_timelines(communicator_, timelines_.all());
        auto const replace = nlohmann::ordered_json::error_handler_t::replace;
        frames_.folder().finish(summary.dump(2, ' ', false, replace) + "\n",
                                timeline.dump() + "\n");
        if (root_) return summary;
        return {{"valid", valid}, {"run", summary.at("run")}};
    }

    Scene const& scene_;
    Communicator const& communicator_;
    RunOptions options_;
    bool root_;  // this is rank 0
    Axes axes_;
    double implicit_step_;
    RunOrigin origin_;
    RankShares shares_;
    std::future<Sites> sites_of_scene_;  // computed while the system is made, after ranks have
                                         // measured their speeds
    ChainSystem system_;
    std::unique_ptr<Stepper> stepper_;
    MessageCount messages_;
    KeptTimelines timelines_;
    SweepWatch watch_;
    RunVerdict verdict_{scene_};
    RunRecord record_;
    Pace pace_;
    /// Only rank 0 asks for checkpoints.
    Requests requests_{options_.stop, root_ ? scene_.output.checkpoint_minutes : 0.0};
    FrameWriter frames_;  // last member: a concurrent write ends before what it uses
};

}  // namespace

nlohmann::ordered_json run_simulation(Scene const& scene, Communicator const& communicator,
                                      RunOptions const& options) {
    if (!scene.dynamics.given)
        throw InputError("the scene has no dynamics section", scene.file,
                         "add `dynamics: {integrator: ..., step: ..., steps: ...}`");
    if (!options.steps && scene.dynamics.steps == 0 && !scene.dynamics.has_steps)
        throw InputError("no steps to run", scene.file + ": dynamics.steps",
                         "set the number there or with --steps");
    std::optional<RelaxedScene> const relaxed =
        options.restart.empty()
            ? relaxed_where_asked(scene, communicator, relaxation_says(options.quiet))
            : std::nullopt;
    Scene const& start = relaxed ? relaxed->scene : scene;
    if (options.restart.empty() && !relaxed) refuse_coinciding(scene, communicator);
    std::optional<StartRelaxation> const relaxation =
        relaxed ? std::optional(relaxed->relaxation) : std::nullopt;
    // Joint coordinates cannot draw thermal velocities themselves, so absolute coordinates draw
    // them.
    if (uses_joint_coordinates(scene.dynamics.integrator)) {
        Scene const with_velocities = with_start_velocities(start, communicator);
        return Run(with_velocities, communicator, options, relaxation).run();
    }
    return Run(start, communicator, options, relaxation).run();
}

}  // namespace catena
