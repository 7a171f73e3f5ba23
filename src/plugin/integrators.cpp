// The integrators and their XML.
#include "plugin/integrators.hpp"

#include <openmm/internal/ContextImpl.h>
#include <openmm/serialization/SerializationNode.h>
#include <openmm/serialization/SerializationProxy.h>

#include <memory>

#include "error.hpp"
#include "plugin/reference_constraints.hpp"

namespace catena::plugin {
namespace {

/// What all integrators keep in XML.
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

void ChainLangevinIntegrator::initialize(OpenMM::ContextImpl& made) {
    solve_constraints(made, held(), name);
    LangevinMiddleIntegrator::initialize(made);
}

void ChainVerletIntegrator::initialize(OpenMM::ContextImpl& made) {
    solve_constraints(made, held(), name);
    VerletIntegrator::initialize(made);
}

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
