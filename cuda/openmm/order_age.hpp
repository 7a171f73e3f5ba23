// When OpenMM's particles are brought into a new order.
#pragma once

namespace catena::cuda {

/// Age of the order of OpenMM's particles. OpenMM's own integrators reorder after 250 evaluations,
/// which would cost a twentieth of a step of 100,000 beads. Chains move little in that time. In a
/// condensate of 7,143 chains OpenMM's forces take as long before a reordering after 6,600
/// evaluations as after it (2.11 ms, H200).
class OrderAge {
  public:
    /// Evaluations of an order without checks of how far beads have moved, and with such checks.
    static constexpr int unchecked = 1000, checked = 8000;

    /// `most`: number of evaluations after which an order ends.
    explicit OrderAge(int most) : most_(most) {}
    /// True from the end of one order to the end of the next order's first evaluation. Particles
    /// are reordered in between.
    bool begins() const { return evaluations_ == 0; }
    void begin() {
        evaluations_ = 0;
        moved_ = 0;
    }
    /// Ends the order before its time.
    void end() { evaluations_ = 0; }
    /// Sets the number of evaluations after which orders end.
    void set_most(int evaluations) { most_ = evaluations; }
    /// Records that a list was built which holds until a bead has moved the distance `lasts`, nm.
    void note_list(double lasts) { moved_ += lasts + most_of_a_step; }
    /// Counts an evaluation, which may be the last one of the order.
    void note_evaluation() { evaluations_ = moved_ < most_moved ? (evaluations_ + 1) % most_ : 0; }

  private:
    /// Particles are also reordered before a bead can have moved this distance, nm, as far as lists
    /// tell: coordinates far from their periodic cell lose digits in single precision. A bead may
    /// exceed the distance for which a list lasts by its motion in one step, nm.
    static constexpr double most_moved = 80, most_of_a_step = 0.04;
    int most_, evaluations_ = 0;
    double moved_ = 0;  // distance that a bead may have moved since the last reordering, nm
};

}  // namespace catena::cuda
