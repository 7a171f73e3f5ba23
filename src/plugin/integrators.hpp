// OpenMM integrators whose constraints Catena solves.
#pragma once

#include <OpenMM.h>
#include <openmm/kernels.h>

#include <memory>
#include <string>
#include <type_traits>

#include "plugin/device_constraints.hpp"
#include "plugin/held_constraints.hpp"

namespace catena::plugin {

/// An integrator of OpenMM (`Base`, whose steps are taken by `StepKernel`), with constraints solved
/// by the divide-and-conquer algorithm. On the platforms Reference and CPU, whatever else applies
/// constraints in its Context uses that solution too.
template <class Base, class StepKernel>
class ChainIntegrator : public Base, public HeldConstraints {
  public:
    /// Throws what OpenMM throws.
    using Base::Base;
    void step(int steps) override;
    double getConstraintTolerance() const override;

  protected:
    /// Throws InputError if the System's constraints or the platform are not supported.
    void initialize(OpenMM::ContextImpl& made) override;
    void cleanup() override;
    void stateChanged(OpenMM::State::DataType changed) override;
    double computeKineticEnergy() override;
    /// Name in XML files and messages.
    virtual char const* type() const = 0;

  private:
    /// True for Langevin dynamics, which projects velocities and has velocities at whole steps.
    static constexpr bool takes_noise = std::is_same_v<Base, OpenMM::LangevinMiddleIntegrator>;
    void step_on_device();
    /// Step on a GPU: OpenMM's kernel, and the constraints before and after it.
    OpenMM::Kernel kernel_;
    std::unique_ptr<DeviceConstraints> device_;
    /// True while OpenMM's kernel takes a step on a GPU: its own constraints then do nothing.
    bool lets_pass_ = false;
};

/// OpenMM's LangevinMiddleIntegrator: temperature in K, friction in 1/ps, step in ps.
class ChainLangevinIntegrator final
    : public ChainIntegrator<OpenMM::LangevinMiddleIntegrator,
                             OpenMM::IntegrateLangevinMiddleStepKernel> {
  public:
    static constexpr char const* name = "ChainLangevinIntegrator";
    using ChainIntegrator::ChainIntegrator;
    char const* type() const override { return name; }
};

/// OpenMM's VerletIntegrator: step in ps.
class ChainVerletIntegrator final
    : public ChainIntegrator<OpenMM::VerletIntegrator, OpenMM::IntegrateVerletStepKernel> {
  public:
    static constexpr char const* name = "ChainVerletIntegrator";
    using ChainIntegrator::ChainIntegrator;
    char const* type() const override { return name; }
};

/// Returns the constraints that an integrator holds. Throws InputError if it is not one of these.
HeldConstraints& held_by(OpenMM::Integrator& integrator);

/// Makes the integrators known to OpenMM's XmlSerializer. Further calls do nothing. Throws
/// InputError if the OpenMM library in memory has another version than that of the build.
void register_integrators();

}  // namespace catena::plugin
