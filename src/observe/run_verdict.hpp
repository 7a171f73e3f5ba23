// What a run keeps for its verdict while it goes, over restarts too.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/output.hpp"
#include "observe/verdict.hpp"

namespace catena {

class RunVerdict {
  public:
    explicit RunVerdict(Scene const& scene) : scene_(scene), energies_(scene) {}
    /// Of joints at a step.
    void note_error(std::int64_t step, double error);
    /// Of joints where the run ends: no restart takes it over, since the undisturbed run need not
    /// have looked there.
    void note_end(std::int64_t step, double error) { end_ = {step, error}; }
    /// Distances from the origin.
    void note_coordinate(double distance) {
        largest_coordinate_ = std::max(largest_coordinate_, distance);
    }
    /// A frame's energies, in the scene's units; `potential`: where it was found.
    void add_frame(std::int64_t step, double kinetic, std::optional<double> potential) {
        energies_.add(step, kinetic, potential);
    }

    /// Into a checkpoint; rank 0's counts.
    void save(Checkpoint&) const;
    /// From one. Returns a note where the checkpoint does not hold what the verdict needs; empty
    /// where it does. InputError where it holds what no run of so many steps can have written.
    std::string restore(Checkpoint const&);
    /// The verdict begins with a branch, whose start is another run's state.
    void branch() { energies_.begins_midway(); }

    double largest_error() const { return std::max(worst_.error, end_.error); }
    /// What frames and joints say, on rank 0.
    std::vector<RunCheck> checks() const;

  private:
    struct JointError {
        std::int64_t step = 0;
        double error = 0;
    };
    Scene const& scene_;
    EnergyWatch energies_;
    JointError worst_, end_;
    double largest_coordinate_ = 0;
    std::optional<std::int64_t> covers_from_;  // energies before that step were not kept
};

}  // namespace catena
