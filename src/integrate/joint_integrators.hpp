// Steps in joint coordinates: nothing drifts apart but jointed tips, which are to be closed after every step (ChainSystem::close_tips).
#pragma once

#include <memory>

#include "integrate/chain_system.hpp"

namespace catena {

class JointIntegrator {
  public:
    virtual ~JointIntegrator() = default;
    /// One step of length h of all groups' states, whose time is their own. Collective.
    virtual void step(double h) = 0;
    /// What the next step needs beside the states is made where it is not there yet. Collective.
    virtual void prepare() {}
    virtual int evaluations_a_step() const = 0;
    /// Whether that is the groups' carried rates.
    virtual bool carries_rates() const { return false; }
    /// These were set from outside.
    virtual void restored() {}
};

/// The classical fourth-order Runge-Kutta step (the chapter's integrator). Quaternions follow q' = 1/2 q (0, omega) and are normalised
/// at the end of the step.
std::unique_ptr<JointIntegrator> make_runge_kutta4(ChainSystem&);

/// Velocity Verlet for accelerations that depend on velocities, one evaluation a step, second order (Groot & Warren, J. Chem. Phys. 107,
/// 4423, 1997, with lambda = 1): q moves by h q' + h^2/2 q'', the acceleration is taken there with q' + h q'', and q' gets the
/// mean of both accelerations. Orientations move by the exponential of that rotation vector.
std::unique_ptr<JointIntegrator> make_velocity_verlet(ChainSystem&);

}  // namespace catena
