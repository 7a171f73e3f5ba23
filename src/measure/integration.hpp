// Trajectory: integration of a scene without output files, for the studies.
#pragma once

#include <memory>

#include "integrate/stepper.hpp"

namespace catena {

/// Integrator and step of a study.
struct Stepping {
    Integrator integrator = Integrator::rk4;
    double step = 0;
    // Above 0: tolerance of dormand-prince, whose inner steps end where each step does.
    double tolerance = 0;
};

/// A scene with its integrator and its present state.
class Trajectory {
  public:
    /// Prepares the scene at its start, with friction 0. `solver.refine` is used if the
    /// integrator's solutions are refined (is_refined()). Collective.
    Trajectory(Scene, Communicator const&, Stepping const&);
    /// Advances by `steps` time steps and waits for the result. Collective.
    void run(std::int64_t steps);
    /// Returns the bodies' motion on rank 0. Collective.
    SceneMotion snapshot();
    /// Kinetic and total energy, kJ/mol (`units: si`: J).
    struct Energy {
        double kinetic = 0, total = 0;
    };
    /// Returns the present energy, valid on rank 0. Collective.
    Energy energy();
    /// Counts of accepted and rejected inner steps.
    struct InnerSteps {
        std::int64_t taken = 0, rejected = 0;
    };
    /// Returns the counts of an adaptive run; zeros for other runs.
    InnerSteps inner_steps() const;

  private:
    Scene scene_;
    ChainSystem system_;
    std::unique_ptr<Stepper> stepper_;
    std::int64_t done_ = 0;
};

}  // namespace catena
