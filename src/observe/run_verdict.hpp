// Data that a run collects for its verdict, over restarts too.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/output.hpp"
#include "observe/verdict.hpp"

namespace catena {

/// Largest joint error, largest coordinate and energies of a run, from which its checks are
/// computed. Frames count on rank 0.
class RunVerdict {
  public:
    explicit RunVerdict(Scene const& scene) : scene_(scene), energies_(scene) {}
    /// Records the constraint error of joints at a step, if it is the largest so far.
    void note_error(std::int64_t step, double error);
    /// Records the constraint error where the run ends. A restart does not inherit it, because the
    /// uninterrupted run need not have computed it there.
    void note_end(std::int64_t step, double error) { end_ = {step, error}; }
    /// Records the distance of a body from the origin.
    void note_coordinate(double distance) {
        largest_coordinate_ = std::max(largest_coordinate_, distance);
    }
    /// Adds a frame's energies in the scene's units. `potential`: empty if it was not computed.
    void add_frame(std::int64_t step, double kinetic, std::optional<double> potential) {
        energies_.add(step, kinetic, potential);
    }

    /// Writes the data to a checkpoint. Rank 0's data are the ones kept.
    void save(Checkpoint&) const;
    /// Restores the data from a checkpoint. Returns a note if the checkpoint lacks what the verdict
    /// needs, else an empty text. Throws InputError for data that no run of so many steps can have
    /// written.
    std::string restore(Checkpoint const&);
    /// Begins the verdict at a branch, whose start is another run's state.
    void branch() { energies_.begins_midway(); }

    double largest_error() const { return std::max(worst_.error, end_.error); }
    /// Returns the checks of joints, energy, temperature and coordinates. Rank 0 only.
    std::vector<RunCheck> checks() const;

  private:
    struct JointError {
        std::int64_t step = 0;
        double error = 0;
    };
    Scene const& scene_;
    EnergyWatch energies_;    // energies of frames
    JointError worst_, end_;  // largest so far; where the run ends
    double largest_coordinate_ = 0;
    std::optional<std::int64_t> covers_from_;  // step before which energies were not kept
};

}  // namespace catena
