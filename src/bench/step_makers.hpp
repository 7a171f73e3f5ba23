// Integrators for benchmarks, Catena's and OpenMM's own, without output files.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "console/requests.hpp"
#include "force/openmm_integrator.hpp"
#include "integrate/stepper.hpp"

namespace catena::command {

/// Runs the integrator of a scene.
class CatenaSteps {
  public:
    /// Constructs the system and the integrator; throws what ChainSystem and make_stepper throw.
    CatenaSteps(Scene scene, Communicator const& communicator);
    /// Makes this many steps and waits for them. Throws ComputationError if they fail.
    void step(int count);
    /// Makes further steps and returns their phases.
    std::vector<StepTimeline> timelines(int count);
    /// Adds a projection sweep from now on if the joints come close to their tolerance, as `catena
    /// run` does.
    void adapt();
    /// Returns the bodies in scene order with their present velocities.
    SceneMotion observe();
    /// Returns the sum of all terms of the potential energy, kJ/mol.
    double energy();

    Scene const& scene() const { return scene_; }
    ChainSystem& system() { return system_; }
    /// Largest constraint error after any call of step().
    double constraint_error() const { return error_; }
    double tolerance() const { return scene_.dynamics.constraint_tolerance; }

  private:
    void advance(StepTimeline*);
    void wait();
    Scene scene_;
    ChainSystem system_;
    SweepWatch watch_;
    std::unique_ptr<Stepper> stepper_;
    std::int64_t n_ = 0;
    double error_ = 0, last_error_ = 0;
};

/// Returns the backend of a benchmark that takes one: the named one, or the GPU if there is one.
Backend backend_of(BenchRequest const& request);

/// Returns the scene's dynamics in the form of OpenMM's own integrator, on the first GPU if the
/// chains are on one.
OwnRun own_run(Scene const& scene, Backend backend);

/// Throws InputError "this benchmark is for one rank" if there are more.
void need_one_rank(Communicator const& communicator, char const* name);

}  // namespace catena::command
