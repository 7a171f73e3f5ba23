// What takes steps in benchmarks, Catena's integrators and OpenMM's own, without files.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "console/requests.hpp"
#include "force/openmm_integrator.hpp"
#include "integrate/stepper.hpp"

namespace catena::command {

/// A scene's integrator.
class CatenaSteps {
  public:
    /// As ChainSystem and make_stepper; throws what they throw.
    CatenaSteps(Scene scene, Communicator const& communicator);
    /// Takes so many steps, and waits for them. Throws ComputationError where they fail.
    void step(int count);
    /// Some more, with their phases.
    std::vector<StepTimeline> timelines(int count);
    /// Another projection sweep from now on where the joints have come near to their tolerance, as
    /// `catena run` does.
    void adapt();
    /// Bodies in scene order with the velocities of now.
    ChainSystem::Snapshot observe();
    /// kJ/mol, all terms.
    double energy();

    Scene const& scene() const { return scene_; }
    ChainSystem& system() { return system_; }
    /// The largest after any step(), and of the last one.
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

/// The backend of a benchmark that takes one: the GPU's where there is one.
Backend backend_of(BenchRequest const& request);

/// The scene's dynamics as OpenMM's own integrator takes it, on the first GPU where the chains are
/// on one.
OwnRun own_run(Scene const& scene, Backend backend);

/// InputError where there are more: "this benchmark is for one rank".
void need_one_rank(Communicator const& communicator, char const* name);

}  // namespace catena::command
