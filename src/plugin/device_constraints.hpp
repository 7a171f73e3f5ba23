// Constraints on OpenMM's GPU platforms (CUDA, HIP, OpenCL).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/constraint_chains.hpp"

namespace OpenMM {
class ContextImpl;
}

namespace catena::plugin {

/// Constraints of a Context whose state is on a GPU. OpenMM's own kernels take the steps; these
/// functions project velocities before and close constraints after each.
class DeviceConstraints {
  public:
    virtual ~DeviceConstraints() = default;
    /// Keeps the directions of the constraints at the present positions. If `project`, changes
    /// velocities so that a kick by the present forces over `step` (ps) ends without relative
    /// velocities along the constraints.
    virtual void before_step(double step, bool project) = 0;
    /// Closes the constraints after a step of length `step`, as LinkSolver::close() does, and adds
    /// the mean velocity of that motion. Throws ComputationError if constraints stay open; the
    /// error is read every few steps only.
    virtual void after_step(double step, double tolerance) = 0;
    /// Kinetic energy of velocities that lead the present ones by `shift` (ps) and have been
    /// projected, kJ/mol. Forces must be up to date. Absent if OpenMM's own function is right.
    virtual std::optional<double> shifted_kinetic_energy(double shift) = 0;
    /// Takes note that the user has changed positions or velocities.
    virtual void note_change() = 0;
};

/// True if a platform keeps its state on a GPU in a way known here.
bool is_device_platform(std::string const& name);

/// Returns the constraints of a Context, or null if it has none to solve. Its platform must be a
/// device platform. `unknown`: OpenMM was not told of the constraints when the Context was created.
/// What else applies them in the Context then gets a solver on the host. `user` names the
/// integrator for messages. Throws InputError for constraints that form rings, trees or nets, and
/// where constraint_chains() does.
std::unique_ptr<DeviceConstraints> make_device_constraints(OpenMM::ContextImpl& context,
                                                           bool unknown, std::string const& user);

}  // namespace catena::plugin
