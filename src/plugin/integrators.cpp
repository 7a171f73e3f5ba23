// The integrators and their XML.
#include "plugin/integrators.hpp"

#include <openmm/internal/ContextImpl.h>
#include <openmm/serialization/SerializationNode.h>
#include <openmm/serialization/SerializationProxy.h>

#include <memory>
#include <type_traits>

#include "error.hpp"
#include "plugin/reference_constraints.hpp"
#include "plugin/vectors.hpp"

namespace catena::plugin {
namespace {

/// Properties that all integrators keep in XML.
void write(OpenMM::Integrator const& integrator, OpenMM::SerializationNode& node) {
    node.setIntProperty("version", 1);
    node.setDoubleProperty("stepSize", integrator.getStepSize());
    node.setDoubleProperty("constraintTolerance", integrator.getConstraintTolerance());
    node.setIntProperty("forceGroups", integrator.getIntegrationForceGroups());
}
void read(OpenMM::Integrator& integrator, OpenMM::SerializationNode const& node) {
    if (node.getIntProperty("version") != 1)
        throw OpenMM::OpenMMException(
            "an integrator of a later version of Catena (XML): install "
            "that version");
    integrator.setStepSize(node.getDoubleProperty("stepSize"));
    integrator.setConstraintTolerance(node.getDoubleProperty("constraintTolerance"));
    integrator.setIntegrationForceGroups(node.getIntProperty("forceGroups"));
}

class LangevinProxy final : public OpenMM::SerializationProxy {
  public:
    LangevinProxy() : SerializationProxy(ChainLangevinIntegrator::name) {}
    void serialize(void const* object, OpenMM::SerializationNode& node) const override {
        auto const& integrator = *static_cast<ChainLangevinIntegrator const*>(object);
        write(integrator, node);
        node.setDoubleProperty("temperature", integrator.getTemperature());
        node.setDoubleProperty("friction", integrator.getFriction());
        node.setIntProperty("randomSeed", integrator.getRandomNumberSeed());
    }
    void* deserialize(OpenMM::SerializationNode const& node) const override {
        auto integrator = std::make_unique<ChainLangevinIntegrator>(
            node.getDoubleProperty("temperature"), node.getDoubleProperty("friction"),
            node.getDoubleProperty("stepSize"));
        read(*integrator, node);
        integrator->setRandomNumberSeed(node.getIntProperty("randomSeed"));
        return integrator.release();
    }
};

class VerletProxy final : public OpenMM::SerializationProxy {
  public:
    VerletProxy() : SerializationProxy(ChainVerletIntegrator::name) {}
    void serialize(void const* object, OpenMM::SerializationNode& node) const override {
        write(*static_cast<ChainVerletIntegrator const*>(object), node);
    }
    void* deserialize(OpenMM::SerializationNode const& node) const override {
        auto integrator =
            std::make_unique<ChainVerletIntegrator>(node.getDoubleProperty("stepSize"));
        read(*integrator, node);
        return integrator.release();
    }
};

}  // namespace

template <class Base, class StepKernel>
void ChainIntegrator<Base, StepKernel>::initialize(OpenMM::ContextImpl& made) {
    std::string const platform = made.getPlatform().getName();
    // From here on OpenMM does not prepare constraints, but finds molecules by them.
    bool const unknown = put_back(const_cast<OpenMM::System&>(made.getSystem()));
    if (!is_device_platform(platform)) {
        solve_constraints(made, type());
        return Base::initialize(made);
    }
    if (this->owner != nullptr && &made.getOwner() != this->owner)
        throw OpenMM::OpenMMException("This Integrator is already bound to a context");
    kernel_ = made.getPlatform().createKernel(StepKernel::Name(), made);
    kernel_.getAs<StepKernel>().initialize(made.getSystem(), *this);
    device_ = make_device_constraints(made, unknown, type());
    this->context = &made;
    this->owner = &made.getOwner();
}

template <class Base, class StepKernel>
void ChainIntegrator<Base, StepKernel>::cleanup() {
    device_.reset();
    kernel_ = OpenMM::Kernel();
    Base::cleanup();
}

template <class Base, class StepKernel>
void ChainIntegrator<Base, StepKernel>::stateChanged(OpenMM::State::DataType changed) {
    if (device_) device_->note_change();
    Base::stateChanged(changed);
}

template <class Base, class StepKernel>
double ChainIntegrator<Base, StepKernel>::getConstraintTolerance() const {
    // Distances from 0 to twice their values are within this tolerance.
    return lets_pass_ ? 1.0 : Base::getConstraintTolerance();
}

template <class Base, class StepKernel>
double ChainIntegrator<Base, StepKernel>::computeKineticEnergy() {
    if (!is_device_platform(this->context->getPlatform().getName()))
        return Base::computeKineticEnergy();
    double const shift = takes_noise ? 0 : this->getStepSize() / 2;
    std::optional<double> const own =
        device_ ? device_->shifted_kinetic_energy(shift) : std::nullopt;
    return own ? *own : kernel_.getAs<StepKernel>().computeKineticEnergy(*this->context, *this);
}

template <class Base, class StepKernel>
void ChainIntegrator<Base, StepKernel>::step(int steps) {
    if (this->context == nullptr || !is_device_platform(this->context->getPlatform().getName()))
        return Base::step(steps);
    for (int i = 0; i < steps; ++i) {
        this->context->updateContextState();
        this->context->calcForcesAndEnergy(true, false, this->getIntegrationForceGroups());
        step_on_device();
    }
}

template <class Base, class StepKernel>
void ChainIntegrator<Base, StepKernel>::step_on_device() {
    auto& stepper = kernel_.getAs<StepKernel>();
    if (!device_) return stepper.execute(*this->context, *this);
    double const step = this->getStepSize();
    device_->before_step(step, takes_noise);
    lets_pass_ = true;
    try {
        stepper.execute(*this->context, *this);
    } catch (...) {
        lets_pass_ = false;
        throw;
    }
    lets_pass_ = false;
    as_openmm_error(type(), [&] { device_->after_step(step, this->getConstraintTolerance()); });
    this->context->computeVirtualSites();
}

template class ChainIntegrator<OpenMM::LangevinMiddleIntegrator,
                               OpenMM::IntegrateLangevinMiddleStepKernel>;
template class ChainIntegrator<OpenMM::VerletIntegrator, OpenMM::IntegrateVerletStepKernel>;

HeldConstraints& held_by(OpenMM::Integrator& integrator) {
    auto* const held = dynamic_cast<HeldConstraints*>(&integrator);
    if (held == nullptr)
        throw InputError("an integrator that is not Catena's", "catena.openmm.prepared",
                         "give a ChainLangevinIntegrator or a ChainVerletIntegrator");
    return *held;
}

void register_integrators() {
    std::string const version = OpenMM::Platform::getOpenMMVersion(), series = CATENA_OPENMM_SERIES;
    if (version != series && !version.starts_with(series + "."))
        throw InputError("catena was built for OpenMM " + series, "OpenMM " + version,
                         "install that series, or install catena again");
    static bool const done = [] {
        OpenMM::SerializationProxy::registerProxy(typeid(ChainLangevinIntegrator),
                                                  new LangevinProxy);
        OpenMM::SerializationProxy::registerProxy(typeid(ChainVerletIntegrator), new VerletProxy);
        return true;
    }();
    static_cast<void>(done);
}

}  // namespace catena::plugin
