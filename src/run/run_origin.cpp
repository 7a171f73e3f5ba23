// Implements the beginning of a run: reading, restoring and continuing checkpoints.
#include "run/run_origin.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "error.hpp"
#include "integrate/checkpoint_values.hpp"
#include "mpi/first_rank.hpp"
#include "run/branch.hpp"
#include "run/rank_exchange.hpp"

namespace catena {
namespace {

// Names of integers, notes and arrays in checkpoints.
constexpr char const *step_of_branch = "branched_at", *note_of_platform = "openmm_platform",
                     *array_of_watch = "sweep_watch", *note_of_tree = "tree_table";

/// Platform and precision of OpenMM, as kept in checkpoints.
std::string platform_of(ChainSystem const& system) {
    std::string const& precision = system.scene().forces.openmm->precision;
    return system.openmm()->platform() + (precision.empty() ? "" : ", " + precision);
}

}  // namespace

RunOrigin::RunOrigin(Scene const& scene, Communicator const& communicator,
                     RunOptions const& options)
    : scene_(scene),
      communicator_(communicator),
      options_(options),
      last_(options.steps.value_or(scene.dynamics.steps)) {
    if (is_restart()) from_ = read();
    if (communicator.rank() == 0) keep_values(scene, values_of_scene_);
}

Checkpoint RunOrigin::read() {
    Checkpoint c;
    on_first_rank(communicator_, [&] {
        c = read_checkpoint(options_.restart);
        if (options_.branch)
            changes_ = branch_changes(c, scene_, options_.restart);
        else
            require_own(c, scene_, options_.restart);
        if (c.notes[note_of_tree] != std::to_string(dca::tree_table_version))
            throw InputError("the checkpoint was made with tree table " + c.notes[note_of_tree] +
                                 ", this version has " + std::to_string(dca::tree_table_version),
                             options_.restart, "continue with the version that made it");
    });
    share(communicator_, c);
    return c;
}

std::vector<double> RunOrigin::shares() const {
    if (!from_) return {};
    auto const found = from_->arrays.find(array_of_shares);
    return found == from_->arrays.end() ? std::vector<double>() : found->second;
}

void RunOrigin::restore(Parts const& run) {
    if (is_restart()) {
        Checkpoint c = *std::exchange(from_, std::nullopt);
        auto const made_on = c.notes.find(note_of_platform);
        if (run.system.openmm() && made_on != c.notes.end() &&
            made_on->second != platform_of(run.system))
            run.notes.push_back(
                "the checkpoint was made on OpenMM's platform " + made_on->second +
                ", this run continues on " + platform_of(run.system) +
                ", whose forces have other rounding errors (forces.openmm.platform chooses)");
        run.system.set_state(c.arrays);
        first_ = c.step;
        if (options_.branch)
            branch(std::move(c), run);
        else
            continue_run(c, run);
    }
    if (last_ < first_)
        throw InputError("the checkpoint is at step " + std::to_string(first_) +
                             ", after the end of the run at step " + std::to_string(last_) +
                             (options_.steps ? " (--steps)" : " (dynamics.steps)"),
                         options_.restart,
                         "request more than " + std::to_string(first_) +
                             " steps with --steps, which counts from the scene's start");
}

void RunOrigin::continue_run(Checkpoint const& c, Parts const& run) {
    time_origin_ = number_in(c, array_of_origin, 0);
    if (auto const found = c.integers.find(number_of_records); found != c.integers.end())
        records_before_ = found->second;
    if (auto const found = c.integers.find(whether_frame); found != c.integers.end())
        was_frame_ = found->second != 0;
    if (c.integers.contains(step_of_branch)) count_from_branch(step_of(c, step_of_branch, 0));
    run.stepper.restore(c);
    if (std::string const note = run.verdict.restore(c); !note.empty()) run.notes.push_back(note);
    if (std::vector<double> const watch = few_numbers_of(c, array_of_watch, 2); !watch.empty())
        run.watch.set_state(watch);
}

void RunOrigin::branch(Checkpoint c, Parts const& run) {
    double const h = scene_.dynamics.step;
    time_origin_ = number_in(c, array_of_origin, 0);
    if (number_in(c, array_of_step, h) != h)
        time_origin_ = c.time - static_cast<double>(c.step) * h;
    c.arrays[array_of_origin] = {time_origin_};
    run.stepper.branch(c);
    run.verdict.branch();
    count_from_branch(c.step);
    if (communicator_.rank() == 0)
        run.notes.push_back(note_of_branch(options_.restart, c.step, changes_));
}

void RunOrigin::count_from_branch(std::int64_t step) {
    branched_at_ = step;
    if (!options_.steps) last_ = step + scene_.dynamics.steps;
}

void RunOrigin::save(Checkpoint& c, Parts const& run) const {
    c.time = time(c.step);
    c.scene_hash = scene_.hash;
    c.arrays[array_of_step] = {scene_.dynamics.step};
    if (time_origin_ != 0) c.arrays[array_of_origin] = {time_origin_};
    if (branched_at_) c.integers[step_of_branch] = *branched_at_;
    if (communicator_.rank() == 0) c.notes.insert(values_of_scene_.begin(), values_of_scene_.end());
    c.notes["integrator"] = name_of(scene_.dynamics.integrator);
    c.notes[note_of_tree] = std::to_string(dca::tree_table_version);
    if (run.system.openmm()) c.notes[note_of_platform] = platform_of(run.system);
    run.verdict.save(c);
    c.arrays[array_of_watch] = run.watch.state();
    run.stepper.save(c);
}

nlohmann::json RunOrigin::branch_json() const {
    if (!options_.branch) return nullptr;
    return json_of_branch(options_.restart, first_, changes_);
}

}  // namespace catena
