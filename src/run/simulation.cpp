// Implements runs: the loop over time steps, output, checkpoints, restarts, branches and the
// summary.
#include "run/simulation.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "cuda/device/gpu.hpp"
#include "error.hpp"
#include "integrate/checkpoint_values.hpp"
#include "integrate/step_failure.hpp"
#include "integrate/stepper.hpp"
#include "mpi/first_rank.hpp"
#include "observe/run_verdict.hpp"
#include "observe/sites.hpp"
#include "run/branch.hpp"
#include "run/force_summary.hpp"
#include "run/pace.hpp"
#include "run/rank_exchange.hpp"
#include "run/run_folder.hpp"
#include "run/step_messages.hpp"
#include "start/start_report.hpp"
#include "start/start_velocities.hpp"

namespace catena {
namespace {

using nlohmann::json;

/// Steps whose timeline is kept: the first few and then those that write output, up to a limit.
constexpr std::int64_t first_timelines = 5;
constexpr std::size_t most_timelines = 50;
/// Interval of constraint checks. The constraint error is also checked with every output and
/// checkpoint and at the last step. Further checks follow after 1, 2, 4, ... steps, while bodies
/// that started at rest accelerate.
constexpr std::int64_t check_every = 100;

/// Averages of messages per step, for the summary.
json as_json(Traffic const& sum, std::int64_t steps) {
    json a_step;
    sum.for_each([&](char const* name, std::int64_t count) {
        a_step[name] = static_cast<double>(count) / static_cast<double>(steps);
    });
    return a_step;
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
          last_(options.steps.value_or(scene_.dynamics.steps)),
          axes_(uses_joint_coordinates(scene_.dynamics.integrator) ? Axes::joint : Axes::world),
          implicit_step_(is_implicit(scene_.dynamics.integrator) ? scene_.dynamics.step : 0.0),
          from_(options_.restart.empty() ? std::nullopt : std::optional(read_start())),
          shares_(shares()),
          sites_of_scene_(root_ ? std::async([this] { return Sites(scene_); })
                                : std::future<Sites>()),
          system_(scene_, axes_, communicator, implicit_step_, shares_) {
        Integrator const integrator = scene_.dynamics.integrator;
        if (scene_.solver.refine > 0 && !is_refined(integrator))
            throw InputError("solutions with integrator " + std::string(name_of(integrator)) +
                                 " are not refined",
                             "solver.refine",
                             "leave it out, or use rk4, dormand-prince or velocity-verlet if the "
                             "chains allow it");
        stepper_ = make_stepper(system_, scene_.dynamics);
        if (root_) sites_ = sites_of_scene_.get();
        notes_ = scene_.notes;
        if (root_) keep_values(scene_, values_of_scene_);
        start_ = {scene_.start, std::nullopt, std::move(relaxation)};
        warn_of_shared_gpus();
        for (auto const& group : system_.groups()) messages_.emplace_back(*group, scene_);
    }

    /// Runs all steps and returns the summary. Collective.
    json run() {
        std::int64_t const first = options_.restart.empty() ? 0 : restore();
        first_ = first;
        if (last_ < first)
            throw InputError("the checkpoint is at step " + std::to_string(first) +
                                 ", after the end of the run at step " + std::to_string(last_) +
                                 (options_.steps ? " (--steps)" : " (dynamics.steps)"),
                             options_.restart,
                             "request more than " + std::to_string(first) +
                                 " steps with --steps, which counts from the scene's start");
        note_outputs(first);
        Progress progress(options_.quiet || !root_, first, last_, scene_.dynamics.step, scene_.si);
        double const start = seconds_now();
        std::int64_t const rounds = communicator_.rounds();
        StopAgreement agreement(communicator_, [this] { return wish(); }, first);
        saved_at_ = seconds_now();
        for (std::int64_t n = first;; ++n) {
            if (frame_.valid() &&
                frame_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
                end_frame();  // reports a failure of the concurrent write
            bool const writes = is_frame(n);
            bool const saves = scene_.output.checkpoint_every > 0 &&
                               n % scene_.output.checkpoint_every == 0 && n > first;
            bool const looks =
                writes || saves || n % check_every == 0 ||
                (n < check_every && std::has_single_bit(static_cast<std::uint64_t>(n)));
            StepTimeline* const timeline = new_timeline(n, n - first < first_timelines || writes);
            bool const renews = (saves || n == last_) && system_.openmm();
            if (renews)
                system_.openmm()->renew_ghosts();  // same ghosts as after a restart from here
            Traffic const before = chains_traffic();
            bool const mended = !prepare(n, timeline);
            Traffic of_step = chains_traffic() - before;
            if (n == first) open(n);  // forces exist before anything is written or replaced
            int const agreed = n == last_ ? 0 : agreement.reason_at(n);
            bool const saves_by_time = agreed == save_wish;
            stopped_by_ = std::max(0, agreed - save_wish);
            bool const ends = n == last_ || stopped_by_ != 0;
            // A state is checked before it is saved: steps that left joints open cannot be repeated
            // after a restart.
            double const error = looks || saves_by_time || ends || n == first ? look(n) : 0;
            // A check due to the clock counts only if its result makes the run worthless.
            if (looks || error > scene_.dynamics.constraint_tolerance)
                verdict_.note_error(n, error);
            if (looks) adapt(n, error);
            if (writes) output(n, error);
            if (!ends) at_start_.reset();
            if (saves || saves_by_time || ends) checkpoint(n);
            if (ends) {
                if (!writes && !is_kept(n))
                    output(n, error);  // written after the checkpoint: a restart from there equals
                                       // the undisturbed run, which lacks this frame
                end_frame();
                reached_ = n;
                verdict_.note_end(n, error);
                break;
            }
            Traffic const prepared = chains_traffic();
            at_step(n, true, [&] { stepper_->step(n, timeline); });
            of_step += chains_traffic() - prepared;
            stepper_->note_error(n);
            if (n > first && !renews && !mended)
                count_messages(of_step);  // repeated steps may evaluate once more
            if (n == first) {
                system_.wait();
                first_step_after_ = seconds_now() - options_.begun;
            }
            progress.update(n + 1);
            pace_.note(n + 1, first + (last_ - first + 1) / 2, seconds_now());
        }
        progress.finish();
        seconds_ = seconds_now() - start;
        rounds_ = communicator_.rounds() - rounds;
        return finish(first);
    }

  private:
    /// Adds a warning if several ranks use one GPU. Collective.
    void warn_of_shared_gpus() {
        if (!uses_gpu(system_.backend()) || communicator_.size() == 1) return;
        int const ranks = cuda::most_ranks_of_a_gpu(communicator_);
        if (ranks > 1)
            notes_.push_back(
                "warning: " + std::to_string(ranks) +
                " ranks share a GPU, where each waits for the others: start one rank per GPU");
    }
    /// Adds notes about output options without effect.
    void note_outputs(std::int64_t first) {
        std::int64_t const every = scene_.output.every;
        if (last_ > first && every > last_ - first && (last_ - 1) / every == first / every)
            notes_.push_back("output.every = " + std::to_string(every) + " exceeds the " +
                             std::to_string(last_ - first) +
                             " steps of this run: no frame lies between its first and last states");
        if (scene_.output.coordinates && root_ && sites_.topology().bodies.empty())
            notes_.push_back(
                "output.coordinates: no chain has rigid bodies, so there are no coordinates to "
                "write");
    }
    /// Time at step n, ps (s with `units: si`).
    double time(std::int64_t n) const {
        return time_origin_ + static_cast<double>(n) * scene_.dynamics.step;
    }
    /// True if step n has a frame, which depends on the step alone and not on where a run ends. A
    /// branch begins with a frame.
    bool is_frame(std::int64_t n) const {
        return n % scene_.output.every == 0 || (options_.branch && n == first_);
    }

    /// Values on which ranks agree at a step: save, or save_wish + signal to stop.
    static constexpr int save_wish = 1;
    /// Request of this rank: stop, save because of checkpoint_minutes, or 0.
    int wish() const {
        if (int const stop = options_.stop ? options_.stop() : 0; stop != 0)
            return save_wish + stop;
        double const minutes = scene_.output.checkpoint_minutes;
        return root_ && minutes > 0 && seconds_now() - saved_at_ >= 60 * minutes ? save_wish : 0;
    }

    /// Timeline to be filled for step n, or null.
    StepTimeline* new_timeline(std::int64_t n, bool wanted) {
        if (!wanted || timelines_.size() >= most_timelines) return nullptr;
        timelines_.reserve(most_timelines);
        timelines_.push_back({n, {}});
        return &timelines_.back();
    }

    /// Opens the output at the first step, after its forces have been computed. Collective.
    void open(std::int64_t n) {
        at_start_ = observed(true);
        if (system_.openmm() && options_.restart.empty()) start_.forces = look_at_start(system_);
        folder_ = std::make_unique<RunFolder>(scene_, communicator_, options_);
        observables_ = std::make_unique<Observables>(scene_, sites_.topology(), at_start_->terms);
        folder_->open(sites_.topology(), observables_->columns(), go_on());
        if (folder_->frames_way().collective && !root_) sites_ = Sites(scene_, system_.own_runs());
        if (!folder_->wants_topology()) return;
        topology_is_due_ = is_frame(n) && may_write_beside() &&
                           options_.topology_beside.value_or(uses_gpu(system_.backend()));
        if (topology_is_due_) return;
        at_start_->bodies = own_bodies();
        write_topology(*at_start_->bodies);
        folder_->check();
    }
    /// Continuation in existing files. The frame of the checkpoint's step is written again, or
    /// remains as that run's, or is removed. The latter is the frame of a run that ended there,
    /// which the undisturbed run would not have written.
    Continuation go_on() const {
        return {is_frame(first_) || !was_frame_ ? first_ - 1 : first_, records_before_};
    }
    /// True if the frame of step n remains as the preceding run wrote it.
    bool is_kept(std::int64_t n) const {
        return n == first_ && !folder_->wants_topology() && go_on().after_step == n;
    }
    /// Writes the topology files from the bodies at the first step.
    void write_topology(ChainSystem::OwnBodies const& at_start) {
        system_.pass_bodies(at_start, [&](ChainSystem::Bodies const& bodies) {
            folder_->put_topology(sites_.part(bodies, false, system_.executor()),
                                  system_.executor());
        });
        folder_->end_topology();
    }

    /// Observations at a step.
    struct Observed {
        std::vector<EnergyTerm> terms;
        std::optional<ChainSystem::OwnBodies> bodies = std::nullopt;  // computed on demand
    };
    /// Computes what observers need. `anyway`: forces are computed even if nothing requests them.
    Observed observed(bool anyway = false) {
        stepper_->observe({.joint_forces = scene_.output.joint_forces,
                           .energies = anyway || has_energies(scene_)});
        return {has_energies(scene_) ? system_.potential_energy() : std::vector<EnergyTerm>()};
    }
    ChainSystem::OwnBodies own_bodies() {
        return system_.own_bodies(scene_.output.joint_forces,
                                  scene_.output.coordinates && axes_ == Axes::joint);
    }

    /// Frame that is being written.
    struct PendingFrame {
        std::int64_t step;
        double error;
        Observed now;
        std::vector<Vector<double, 6>> at_tips;
    };
    /// True if frames may be written concurrently with steps.
    bool may_write_beside() const {
        return communicator_.size() == 1 && scene_.bodies() >= options_.bodies_beside;
    }
    /// Writes the frame of step n. On one rank with many bodies a separate thread writes it, and a
    /// topology that is due with it. Steps continue until something else must be written.
    void output(std::int64_t n, double error) {
        end_frame();
        pending_ = {n, error, at_start_ ? std::move(*at_start_) : observed(), {}};
        if (!pending_->now.bodies) pending_->now.bodies = own_bodies();
        if (scene_.output.joint_forces)
            for (TipForce const& tip : system_.tip_forces())
                pending_->at_tips.push_back(tip.wrench);
        if (may_write_beside() && write_beside()) return;
        write(*pending_);
        pending_.reset();
        folder_->check();
    }
    /// Writes the pending frame in a thread of its own. Returns false if no thread can be created.
    bool write_beside() {
        try {
            frame_ = std::async(std::launch::async, [this] { write(*pending_); });
        } catch (std::system_error const&) {
            return false;
        }
        ++frames_beside_;
        return true;
    }
    /// Waits for the frame that is being written, if there is one. Throws its failure.
    void end_frame() {
        if (!frame_.valid()) return;
        frame_.get();
        pending_.reset();
        folder_->check();
    }
    /// Writes a frame. Collective; a single rank sends no messages.
    void write(PendingFrame const& frame) {
        if (std::exchange(topology_is_due_, false)) write_topology(*frame.now.bodies);
        folder_->begin(frame.step, time(frame.step));
        observables_->begin();
        bool const together = folder_->frames_way().collective;
        system_.pass_bodies(*frame.now.bodies, [&](ChainSystem::Bodies const& bodies) {
            Frame const part =
                sites_.part(bodies, scene_.output.velocities && !together, system_.executor());
            if (!together) folder_->put(std::span(&part, 1));
            observables_->add(bodies.motion, part.positions);
            for (Vec3 const& x : bodies.motion.position) verdict_.note_coordinate(norm(x));
        });
        if (together) put_own(*frame.now.bodies);
        if (root_) judge(frame);
        folder_->end(frame.at_tips, last_row_);
    }

    /// Computes a frame's row of observables and passes its energies to the verdict. Rank 0 only.
    void judge(PendingFrame const& frame) {
        last_row_ = observables_->row(frame.now.terms, frame.error);
        std::optional<double> potential;
        if (has_energies(scene_)) {
            potential = 0;
            for (EnergyTerm const& term : frame.now.terms) *potential += term.value;
        }
        verdict_.add_frame(frame.step, observables_->kinetic(), potential);
    }

    /// Writes this rank's own bodies of a frame in collective mode.
    void put_own(ChainSystem::OwnBodies const& own) {
        system_.pass_own_bodies(own, [&](std::vector<ChainSystem::Bodies> const& runs) {
            std::vector<Frame> parts(runs.size());
            system_.executor().for_each_of_many_or_few(
                std::ssize(runs), [&](std::int64_t i, Executor const& within) {
                    auto const r = static_cast<std::size_t>(i);
                    parts[r] = sites_.part(runs[r], scene_.output.velocities, within);
                });
            folder_->put(parts);
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
    /// not where a run happens to end: a restart must equal the undisturbed run.
    void adapt(std::int64_t n, double error) {
        if (n == first_ && !options_.restart.empty()) return;  // the preceding run did it
        if (stepper_->adapt(watch_, error, scene_.dynamics.constraint_tolerance))
            notes_.push_back("one more projection sweep from step " + std::to_string(n) + " on");
    }

    /// Messages so far, without those that supply OpenMM, which StepMessages does not predict.
    Traffic chains_traffic() const { return communicator_.traffic() - system_.openmm_traffic(); }

    /// Adds a step's messages, counted and predicted.
    void count_messages(Traffic const& of_step) {
        ++counted_steps_;
        counted_ += of_step;
        for (std::size_t i = 0; i < messages_.size(); ++i)
            predicted_ += messages_[i].a_step(
                stepper_->sweeps(), cut_of(*system_.groups()[i], communicator_.gather_way()),
                stepper_->parts(), stepper_->solved());
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
        end_frame();
        Checkpoint c;
        c.step = n;
        c.time = time(n);
        c.scene_hash = scene_.hash;
        c.arrays[array_of_step] = {scene_.dynamics.step};
        if (time_origin_ != 0) c.arrays[array_of_origin] = {time_origin_};
        c.integers[number_of_records] = folder_->records_before(n) - (is_kept(n) ? 1 : 0);
        c.integers[whether_frame] = is_frame(n) || is_kept(n) ? 1 : 0;
        if (branched_at_) c.integers[step_of_branch] = *branched_at_;
        if (root_) c.notes.insert(values_of_scene_.begin(), values_of_scene_.end());
        c.notes["integrator"] = name_of(scene_.dynamics.integrator);
        c.notes["tree_table"] = std::to_string(dca::tree_table_version);
        if (system_.openmm()) c.notes[note_of_platform] = platform();
        verdict_.save(c);
        c.arrays[array_of_watch] = watch_.state();
        if (!shares_.empty()) c.arrays[array_of_shares] = {shares_.begin(), shares_.end()};
        stepper_->save(c);
        ChainSystem::OwnState own = system_.own_state();
        stepper_->save(own);
        folder_->write_checkpoint(c, system_, own);
        saved_at_ = seconds_now();
    }

    // Names of integers, notes and arrays in checkpoints.
    static constexpr char const *number_of_records = "records_before",
                                *whether_frame = "frame_at_step", *step_of_branch = "branched_at",
                                *note_of_platform = "openmm_platform",
                                *array_of_watch = "sweep_watch", *array_of_shares = "rank_shares";
    /// Platform and precision of OpenMM, as kept in checkpoints.
    std::string platform() const {
        std::string const& precision = scene_.forces.openmm->precision;
        return system_.openmm()->platform() + (precision.empty() ? "" : ", " + precision);
    }

    /// Returns the checkpoint to continue from, on every rank, without its notes and arrays of
    /// bodies. Collective.
    Checkpoint read_start() {
        Checkpoint c;
        on_first_rank(communicator_, [&] {
            c = read_checkpoint(options_.restart);
            if (options_.branch)
                changes_ = branch_changes(c, scene_, options_.restart);
            else
                require_own(c, scene_, options_.restart);
            if (c.notes["tree_table"] != std::to_string(dca::tree_table_version))
                throw InputError("the checkpoint was made with tree table " +
                                     c.notes["tree_table"] + ", this version has " +
                                     std::to_string(dca::tree_table_version),
                                 options_.restart, "continue with the version that made it");
        });
        share(communicator_, c);
        return c;
    }

    /// Shares of the ranks: those of the checkpoint if as many ranks made it, else measured ones. A
    /// restart must equal the undisturbed run, also with OpenMM. Collective.
    dca::Shares shares() {
        if (!scene_.solver.balance || communicator_.size() == 1) return {};
        std::vector<double> const stored =
            from_ ? from_->arrays[array_of_shares] : std::vector<double>();
        shares_are_stored_ = std::ssize(stored) == communicator_.size();
        auto const is_share = [](double share) { return share >= 1 && share <= 1e6; };
        shares_are_stored_ =
            shares_are_stored_ && std::all_of(stored.begin(), stored.end(), is_share);
        if (shares_are_stored_) return {stored.begin(), stored.end()};
        return agree_on_shares(communicator_,
                               options_.own_costs(scene_, axes_, communicator_, implicit_step_));
    }

    /// Restores the state from the checkpoint and returns its step.
    std::int64_t restore() {
        Checkpoint const c = *std::exchange(from_, std::nullopt);
        auto const made_on = c.notes.find(note_of_platform);
        if (system_.openmm() && made_on != c.notes.end() && made_on->second != platform())
            notes_.push_back(
                "the checkpoint was made on OpenMM's platform " + made_on->second +
                ", this run continues on " + platform() +
                ", whose forces have other rounding errors (forces.openmm.platform chooses)");
        system_.set_state(c.arrays);
        if (options_.branch) return branch(c);
        time_origin_ = number_in(c, array_of_origin, 0);
        if (auto const found = c.integers.find(number_of_records); found != c.integers.end())
            records_before_ = found->second;
        if (auto const found = c.integers.find(whether_frame); found != c.integers.end())
            was_frame_ = found->second != 0;
        if (c.integers.contains(step_of_branch)) count_from_branch(step_of(c, step_of_branch, 0));
        stepper_->restore(c);
        if (std::string const note = verdict_.restore(c); !note.empty()) notes_.push_back(note);
        if (std::vector<double> const watch = few_numbers_of(c, array_of_watch, 2); !watch.empty())
            watch_.set_state(watch);
        return c.step;
    }

    /// Begins a branch and returns its first step. Time continues from its value, whatever the
    /// length of a step. Without --steps the branch runs for as many steps as the scene states.
    std::int64_t branch(Checkpoint c) {
        double const h = scene_.dynamics.step;
        time_origin_ = number_in(c, array_of_origin, 0);
        if (number_in(c, array_of_step, h) != h)
            time_origin_ = c.time - static_cast<double>(c.step) * h;
        c.arrays[array_of_origin] = {time_origin_};
        stepper_->branch(c);
        verdict_.branch();
        count_from_branch(c.step);
        if (root_) notes_.push_back(note_of_branch(options_.restart, c.step, changes_));
        return c.step;
    }

    /// Sets the last step of a branch, or of a restart of one, unless --steps is set. It lies as
    /// many steps after the branch's beginning as the scene states.
    void count_from_branch(std::int64_t step) {
        branched_at_ = step;
        if (!options_.steps) last_ = step + scene_.dynamics.steps;
    }

    /// Judges the run, writes the final files and returns the summary. Collective.
    json finish(std::int64_t first) {
        std::vector<RunCheck> const found = root_ ? verdict_.checks() : std::vector<RunCheck>();
        bool const valid = communicator_.sum(all_passed(found) ? 0 : 1) == 0;
        for (RunCheck const& verdict : found)
            if (verdict.passed && !verdict.advice.empty()) notes_.push_back(verdict.advice);
        if (std::string const note = stepper_->note_of_sweeps(); !note.empty())
            notes_.push_back(note);
        json summary = summarise(first, valid, summary_of_forces(system_, reached_ - first));
        summary["verdict"] = as_json(found);
        json const timeline = gather_timelines(communicator_, timelines_);
        folder_->finish(summary.dump(2, ' ', false, json::error_handler_t::replace) + "\n",
                        timeline.dump() + "\n");
        return root_ ? summary : json{{"valid", valid}, {"run", summary["run"]}};
    }

    /// Summary of the run without its verdict. Collective.
    json summarise(std::int64_t first, bool valid, json const& forces) {
        double const steps = static_cast<double>(reached_ - first);
        json s{{"title", scene_.title},
               {"scene", scene_.file},
               {"scene_hash", scene_.hash},
               {"command", options_.command_line},
               {"valid", valid}};
        s["run"] = {{"first_step", first},
                    {"last_step", reached_},
                    {"time", time(reached_)},
                    {"integrator", name_of(scene_.dynamics.integrator)},
                    {"step", scene_.dynamics.step},
                    {"bodies", scene_.bodies()},
                    {"dof", degrees_of_freedom(scene_)}};
        if (json const inner = stepper_->inner_steps(); !inner.is_null()) s["inner_steps"] = inner;
        if (options_.branch) s["branch"] = json_of_branch(options_.restart, first, changes_);
        if (stopped_by_ != 0) s["run"].update({{"stopped_by", stopped_by_}, {"steps", last_}});
        s["speed"] = {{"seconds", seconds_},
                      {"steps_per_second", seconds_ > 0 ? steps / seconds_ : 0.0}};
        if (first_step_after_ > 0) s["speed"]["seconds_to_first_step"] = first_step_after_;
        if (double const rate = pace_.steps_per_second(); rate > 0)
            s["speed"]["steps_per_second_of_second_half"] = rate;
        if (!scene_.si)
            s["speed"]["ns_per_day"] =
                seconds_ > 0 ? steps * scene_.dynamics.step * 1e-3 * 86400 / seconds_ : 0.0;
        s["parallel"] = {
            {"ranks", communicator_.size()},
            {"threads", system_.executor().threads()},
            {"message_passing", message_passing_library()},
            {"gathers", communicator_.gather_way().text()},
            {"frames_written", folder_->frames_way().text},
            {"frames_beside_steps", frames_beside_},
            {"checkpoints_written", folder_->checkpoints_way().text},
            {"message_rounds_per_step", steps > 0 ? static_cast<double>(rounds_) / steps : 0.0}};
        if (!shares_.empty()) s["parallel"].update(json_of_shares());
        std::int64_t const differ = communicator_.sum(counted_ == predicted_ ? 0 : 1);
        if (counted_steps_ > 0)
            s["parallel"]["messages_a_step"] = {{"counted", as_json(counted_, counted_steps_)},
                                                {"predicted", as_json(predicted_, counted_steps_)},
                                                {"ranks_that_differ", differ}};
        json solvers = json::array();
        for (std::size_t i = 0; i < system_.groups().size(); ++i) {
            ChainGroup const& g = *system_.groups()[i];
            SolverReport const r = system_.solver_reports()[i];
            solvers.push_back({{"handle_kind", g.kind()},
                               {"handles", r.handles},
                               {"directions", r.directions},
                               {"chains", g.partition.chains()},
                               {"bodies", g.partition.bodies()},
                               {"run_length", r.run_length},
                               {"depth", r.depth},
                               {"direct_exchange", r.direct_exchange}});
        }
        s["solver"] = {{"backend", name_of(system_.backend())},
                       {"tree_table", dca::tree_table_version},
                       {"groups", solvers}};
        s["solver"].update(stepper_->describe());
        bool const tips = std::any_of(system_.groups().begin(), system_.groups().end(),
                                      [](auto const& g) { return g->has_tips(); });
        if (!system_.absolute().empty() ||
            tips)  // joint coordinates without jointed tips have no constraint error
            s["constraints"] = {{"largest_error", verdict_.largest_error()},
                                {"tolerance", scene_.dynamics.constraint_tolerance}};
        if (system_.openmm()) s["forces"] = forces;
        s["seconds_per_phase"] = system_.seconds();
        s["notes"] = notes_;
        if (options_.restart.empty()) s["start"] = json_of(start_);
        for (std::size_t i = 0; i < last_row_.size(); ++i)
            s["last_observables"][observables_->columns()[i]] = last_row_[i];
        for (char const* name : {"trajectory.h5md", "topology.pdb", "observables.csv",
                                 "checkpoint.h5", "summary.json", "timeline.json", "report.html"})
            s["files"][name] = folder_->path(name);
        for (char const* name : {"topology.cif", "topology.psf"})
            if (std::error_code ignored;
                root_ && std::filesystem::exists(folder_->path(name), ignored))
                s["files"][name] = folder_->path(name);
        return s;
    }

    /// Shares of the ranks and numbers of their bodies.
    json json_of_shares() const {
        double sum = 0;
        for (std::int64_t const share : shares_) sum += static_cast<double>(share);
        json shares = json::array(), bodies = json::array();
        for (std::size_t r = 0; r < shares_.size(); ++r) {
            std::int64_t own = 0;
            for (auto const& group : system_.groups())
                own += group->first_of_rank()[r + 1] - group->first_of_rank()[r];
            shares.push_back(static_cast<double>(shares_[r]) / sum);
            bodies.push_back(own);
        }
        return {{"shares", shares},
                {"shares_from", shares_are_stored_ ? "checkpoint" : "measurement"},
                {"bodies_of_rank", bodies}};
    }

    Scene const& scene_;
    Communicator const& communicator_;
    RunOptions options_;
    bool root_;          // this is rank 0
    std::int64_t last_;  // last step
    Sites sites_;
    Axes axes_;
    double implicit_step_;
    std::vector<scene::ChangedValue> changes_;  // changes of a branch, on rank 0
    std::optional<Checkpoint> from_;            // exists until it is restored
    bool shares_are_stored_ = false;
    dca::Shares shares_;                 // empty: equal shares
    std::future<Sites> sites_of_scene_;  // computed while the system is made, after ranks have
                                         // measured their speeds
    ChainSystem system_;
    std::unique_ptr<Stepper> stepper_;
    std::vector<StepMessages> messages_;  // one per group
    Traffic counted_, predicted_;         // sums over `counted_steps_`, this rank
    std::unique_ptr<RunFolder> folder_;
    std::unique_ptr<Observables> observables_;
    std::vector<StepTimeline> timelines_;
    std::vector<double> last_row_;      // last frame
    std::optional<Observed> at_start_;  // data for the topology and the first frame
    bool topology_is_due_ = false;      // topology files are written with the first frame
    std::vector<std::string> notes_;
    StartReport start_;
    SweepWatch watch_;
    RunVerdict verdict_{scene_};
    double seconds_ = 0;           // duration of all steps
    double first_step_after_ = 0;  // seconds; 0: no step yet
    Pace pace_;
    std::int64_t first_ = 0, reached_ = 0, rounds_ = 0, counted_steps_ = 0, frames_beside_ = 0;
    std::optional<std::int64_t>
        branched_at_;  // step at which the branch began, also after its restart
    int stopped_by_ = 0;
    std::map<std::string, std::string> values_of_scene_;  // for checkpoints, rank 0 only
    double time_origin_ = 0,
           saved_at_ = 0;  // time at step 0; clock at the last checkpoint
    std::int64_t records_before_ =
        0;  // smallest number of frames that the preceding run left before the checkpoint's step
    bool was_frame_ = true;  // the checkpoint's step was a frame, not only that run's last state
    std::optional<PendingFrame> pending_;
    std::future<void> frame_;  // last member: it ends before the members that it uses
};

}  // namespace

json run_simulation(Scene const& scene, Communicator const& communicator,
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
