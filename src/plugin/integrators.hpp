// OpenMM integrators whose constraints Catena solves.
#pragma once

#include <OpenMM.h>

#include <string>
#include <vector>

#include "plugin/held_constraints.hpp"

namespace catena::plugin {

/// OpenMM's LangevinMiddleIntegrator, with constraints solved by the divide-and-conquer algorithm.
/// Whatever else applies constraints in its Context uses that solution too.
class ChainLangevinIntegrator final : public OpenMM::LangevinMiddleIntegrator,
                                      public HeldConstraints {
  public:
    /// Name in XML files, and of the class in messages.
    static constexpr char const* name = "ChainLangevinIntegrator";
    /// Temperature in K, friction in 1/ps, step in ps. Throws what OpenMM throws.
    using OpenMM::LangevinMiddleIntegrator::LangevinMiddleIntegrator;

  protected:
    /// Throws InputError if the System's constraints or the platform are not supported.
    void initialize(OpenMM::ContextImpl& made) override;
};

/// OpenMM's VerletIntegrator, with constraints solved as ChainLangevinIntegrator does.
class ChainVerletIntegrator final : public OpenMM::VerletIntegrator, public HeldConstraints {
  public:
    static constexpr char const* name = "ChainVerletIntegrator";
    using OpenMM::VerletIntegrator::VerletIntegrator;

  protected:
    void initialize(OpenMM::ContextImpl& made) override;
};

/// Returns the constraints that an integrator holds. Throws InputError if it is not one of these.
HeldConstraints& held_by(OpenMM::Integrator& integrator);

/// Makes the integrators known to OpenMM's XmlSerializer. Further calls do nothing. Throws
/// InputError if the OpenMM library in memory has another version than that of the build.
void register_integrators();

}  // namespace catena::plugin
