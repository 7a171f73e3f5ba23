// What a Context applies constraints with, on platforms whose own solver does not know them.
#pragma once

#include <memory>
#include <string>

#include "plugin/link_solver.hpp"

namespace OpenMM {
class ContextImpl;
class System;
}  // namespace OpenMM

namespace catena::plugin {

/// Constraints of a Context in the memory of the host, for what is rare: positions and velocities
/// are copied from OpenMM and back.
class ContextConstraints {
  public:
    /// The constraints are those of the Context's System that are not left to SETTLE.
    explicit ContextConstraints(OpenMM::ContextImpl& context, std::string user);
    void restore_positions(double tolerance);
    void project_velocities();
    /// DeviceConstraints::shifted_kinetic_energy().
    double shifted_kinetic_energy(double shift);

  private:
    LinkSolver& solver();
    OpenMM::ContextImpl& context_;
    std::string user_;
    std::unique_ptr<LinkSolver> solver_;
};

/// Lets Context::applyConstraints() and Context::applyVelocityConstraints(), and OpenMM's functions
/// that call them, use `constraints` after what the platform does.
void apply_in_context(OpenMM::ContextImpl& context,
                      std::shared_ptr<ContextConstraints> constraints);

/// Constraints of a System that are not left to SETTLE, without those of two massless particles.
std::vector<Constraint> constraints_to_solve(OpenMM::System const& system);
/// Mass of each particle of a System, amu.
std::vector<double> masses_of(OpenMM::System const& system);

}  // namespace catena::plugin
