// When a run takes one sweep more to close its joints: their error grows and falls with the chains'
// shape and speed.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace catena {

/// Looks at errors in turn. What rounding leaves, which grows with coordinates, no sweep lessens:
/// one that was added in vain says where that is.
class SweepWatch {
  public:
    /// Whether an error calls for another sweep: above `allowed`, a part of the `tolerance`, and
    /// above rounding.
    bool is_due(double error, double allowed, double tolerance) {
        if (added_at_ > 0 && error > 0.5 * added_at_) in_vain_at_ = std::max(in_vain_at_, error);
        added_at_ = 0;
        return error > std::max({allowed, std::min(2 * in_vain_at_, 0.5 * tolerance),
                                 std::min(rounding_of_joints, 0.1 * tolerance)});
    }
    /// There it was added.
    void added(double error) { added_at_ = error; }

    /// For checkpoints: a restart is to be the undisturbed run.
    std::vector<double> state() const { return {added_at_, in_vain_at_}; }
    void set_state(std::vector<double> const& state) {
        if (state.size() != 2) throw std::invalid_argument("a sweep watch has two numbers");
        added_at_ = state[0], in_vain_at_ = state[1];
    }

  private:
    static constexpr double rounding_of_joints = 1e-13;  // near the origin
    double added_at_ = 0, in_vain_at_ = 0;
};

}  // namespace catena
