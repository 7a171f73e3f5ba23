// The classical fourth-order Runge-Kutta step in joint coordinates (the chapter's integrator). Quaternions follow
// q' = 1/2 q (0, omega) and are normalised at the end of the step.
#pragma once

#include "integrate/joint_dynamics.hpp"

namespace catena {

class RungeKutta4 {
  public:
    explicit RungeKutta4(JointDynamics& dynamics);
    /// One step of length h from `state`, four evaluations. Collective.
    void step(JointState& state, double h);

  private:
    /// state <- start + h (derivative of the positions at `at`, rates)
    void advance(JointState const& start, JointState const& at, JointRates const& rates, double h, JointState& state) const;
    JointDynamics& dynamics_;
    JointState stage_, start_, sum_;
    JointRates rates_;
};

}  // namespace catena
