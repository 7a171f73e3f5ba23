// Implements the collection of verdict data and their place in checkpoints.
#include "observe/run_verdict.hpp"

#include "integrate/checkpoint_values.hpp"

namespace catena {
namespace {

// Names of arrays and integers in checkpoints.
constexpr char const *array_of_error = "largest_constraint_error",
                     *step_of_error = "largest_constraint_error_at",
                     *array_of_coordinate = "largest_coordinate",
                     *array_of_frames = "verdict_frames", *whether_midway = "verdict_begins_midway",
                     *step_covered_from = "verdict_covers_from";

}  // namespace

void RunVerdict::note_error(std::int64_t step, double error) {
    if (error > worst_.error) worst_ = {step, error};
}

void RunVerdict::save(Checkpoint& c) const {
    c.arrays[array_of_error] = {worst_.error};
    c.integers[step_of_error] = worst_.step;
    c.arrays[array_of_coordinate] = {largest_coordinate_};
    c.arrays[array_of_frames] = energies_.state();
    c.integers[whether_midway] = energies_.is_midway();
    if (covers_from_) c.integers[step_covered_from] = *covers_from_;
}

std::string RunVerdict::restore(Checkpoint const& c) {
    for (double const error : few_numbers_of(c, array_of_error, 1)) worst_ = {c.step, error};
    for (double const largest : few_numbers_of(c, array_of_coordinate, 1))
        largest_coordinate_ = largest;
    worst_.step = step_of(c, step_of_error, worst_.step);
    auto const frames = c.arrays.find(array_of_frames);
    if (frames != c.arrays.end()) {
        if (!energies_.set_state(frames->second, c.step))
            refuse_checkpoint(std::string(array_of_frames) + " are not energies of its run");
        if (c.integers.contains(step_covered_from)) covers_from_ = step_of(c, step_covered_from, 0);
        auto const midway = c.integers.find(whether_midway);
        if (midway != c.integers.end() && midway->second != 0) energies_.begins_midway();
    } else {
        covers_from_ = c.step;
        energies_.begins_midway();
    }
    if (!covers_from_) return "";
    return "a checkpoint of this run contains no energies of earlier frames: the verdict on energy "
           "and temperature covers only the steps from " +
           std::to_string(*covers_from_) + " on";
}

std::vector<RunCheck> RunVerdict::checks() const {
    double const tolerance = scene_.dynamics.constraint_tolerance;
    JointError const& worst = end_.error > worst_.error ? end_ : worst_;
    std::vector<RunCheck> all{joints_verdict(worst.error, tolerance, worst.step, "dynamics.step")};
    for (auto const& verdict :
         {energies_.energy(), energies_.temperature(),
          coordinates_verdict(largest_coordinate_, shortest_link(scene_), tolerance, end_.step)})
        if (verdict) all.push_back(*verdict);
    return all;
}

}  // namespace catena
