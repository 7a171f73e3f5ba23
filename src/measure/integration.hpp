// A scene's integrator, without files.
#pragma once

#include <memory>

#include "integrate/stepper.hpp"

namespace catena {

/// How a study steps.
struct Stepping {
    Integrator integrator = Integrator::rk4;
    double step = 0;
    double tolerance = 0;  // above 0: of dormand-prince, whose inner steps end where each step does
};

class Trajectory {
  public:
    /// At friction zero. `solver.refine` counts where the integrator's solutions are refined
    /// (is_refined()).
    Trajectory(Scene, Communicator const&, Stepping const&);
    void run(std::int64_t steps);
    ChainSystem::Snapshot snapshot();
    struct Energy {
        double kinetic = 0, total = 0;
    };
    Energy energy();
    struct InnerSteps {
        std::int64_t taken = 0, rejected = 0;
    };
    /// Of an adaptive run; else none.
    InnerSteps inner_steps() const;

  private:
    Scene scene_;
    ChainSystem system_;
    std::unique_ptr<Stepper> stepper_;
    std::int64_t done_ = 0;
};

}  // namespace catena
