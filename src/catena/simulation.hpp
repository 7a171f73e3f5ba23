// Simulation: a model that moves in time, in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catena/forces.hpp"
#include "catena/scene.hpp"

namespace catena {

/// State after a step. Entries are bodies and beads, in the order of the scene.
struct SimulationState {
    std::int64_t step = 0;
    double time = 0;
    /// Position and velocity of the centre of mass or bead, W.
    std::vector<Triple> position, velocity;
    /// Orientation of B in W; the identity for beads.
    std::vector<UnitQuaternion> orientation;
    /// Angular velocity, B.
    std::vector<Triple> angular_velocity;
    /// Constraint force on each body at its inboard joint or link.
    std::vector<JointForce> joint_force;
    /// Joint positions and rates in the format of Joint, zeros in absolute coordinates. Unused
    /// numbers are zero; of a free joint only the quaternion and the angular velocity are given.
    std::vector<std::array<double, 4>> joint_position;
    std::vector<Triple> joint_rate;
    double kinetic_energy = 0;
    /// Temperature of the kinetic energy, K. Absent if nothing moves freely, if motions are
    /// prescribed, for implicit integrators, and in SI units without a thermostat.
    std::optional<double> temperature;
    /// Potential energy by term: gravity, springs, those of OpenMM, then "own force" if it returns
    /// one.
    std::vector<std::pair<std::string, double>> potential_energy;
    /// Largest relative violation of a constraint.
    double constraint_error = 0;

    /// Sum of all energies.
    double total_energy() const {
        double sum = kinetic_energy;
        for (auto const& term : potential_energy) sum += term.second;
        return sum;
    }
};

/// Called after each step of Simulation::run() with the number of steps so far. It returns false to
/// stop there.
using AfterStep = std::function<bool(std::int64_t step)>;

/// Steps of the integrator that the model's key `dynamics` names.
class Simulation {
  public:
    /// Prepares the model's start: relaxes it if asked, draws thermal velocities, closes joints.
    /// Throws Error if the model is wrong or lacks `dynamics`, if its step is too long for its
    /// springs, or if it combines an own force with a GPU, or with OpenMM's forces on rigid bodies.
    explicit Simulation(Model const& model, OwnForce force = {});
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    /// Takes steps, whatever `dynamics.steps` says, until `after_step` returns false. Returns the
    /// number of steps taken. The states equal those of `catena run` with the same backend and
    /// without `output.checkpoint_every`. Throws Error that names the step if one fails, or if the
    /// state is not finite; only restore() helps then. What `after_step` throws passes, and the
    /// simulation can go on.
    std::int64_t run(std::int64_t steps, AfterStep const& after_step = {});
    /// Returns the present state. Throws Error after a failed step.
    SimulationState state();
    std::int64_t step() const;
    double time() const;
    /// Returns one sentence each on what was assumed, changed or left out at the start, and on
    /// steps that were repeated.
    std::vector<std::string> notes() const;

    /// Returns the present state as bytes. From there restore() continues with the same bits, but
    /// for forces of OpenMM's platforms CPU and CUDA, which remember their neighbour lists.
    std::string checkpoint();
    /// Returns to the state of a checkpoint of the same scene, also after a failed step. Throws
    /// Error, and changes nothing, if the bytes are damaged or belong to another scene.
    void restore(std::string const& checkpoint);

  private:
    class Content;
    std::unique_ptr<Content> content_;
};

}  // namespace catena
