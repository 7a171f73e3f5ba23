// SweepWatch: decides if a run needs another sweep to close its joints, whose violation varies with
// the chains' shape and speed.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace catena {

/// Sees the violations one after the other. Rounding grows with coordinates, and no sweep reduces
/// its contribution. A sweep that was added in vain reveals how large that contribution is.
class SweepWatch {
  public:
    /// True if a violation calls for another sweep: it exceeds `allowed`, which is a fraction of
    /// the `tolerance`, and rounding.
    bool is_due(double error, double allowed, double tolerance) {
        if (added_at_ > 0 && error > 0.5 * added_at_) in_vain_at_ = std::max(in_vain_at_, error);
        added_at_ = 0;
        return error > std::max({allowed, std::min(2 * in_vain_at_, 0.5 * tolerance),
                                 std::min(rounding_of_joints, 0.1 * tolerance)});
    }
    /// Records the violation at which a sweep was added.
    void added(double error) { added_at_ = error; }

    /// State for checkpoints: a restart must reproduce the uninterrupted run.
    std::vector<double> state() const { return {added_at_, in_vain_at_}; }
    void set_state(std::vector<double> const& state) {
        if (state.size() != 2) throw std::invalid_argument("a sweep watch has two numbers");
        added_at_ = state[0], in_vain_at_ = state[1];
    }

  private:
    // Violation due to rounding near the origin.
    static constexpr double rounding_of_joints = 1e-13;
    // violations at which a sweep was added last (0: none since), and in vain
    double added_at_ = 0, in_vain_at_ = 0;
};

}  // namespace catena
