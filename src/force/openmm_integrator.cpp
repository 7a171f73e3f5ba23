// OpenMM's LangevinMiddleIntegrator on the beads of a scene.
#include "force/openmm_integrator.hpp"

#include <OpenMM.h>

#include "error.hpp"
#include "force/platform.hpp"
#include "structure/calvados2.hpp"
#include "systems/model.hpp"

namespace catena {
namespace {

int constexpr no_force = 1 << 30;  // mask of a group without forces

/// OpenMmIntegrator for the CALVADOS 2 model.
class Own final : public OpenMmIntegrator {
  public:
    Own(OpenMmSpec const& spec, BeadSystem const& beads, Communicator const& communicator,
        OwnLinks links, OwnRun const& run, std::vector<Vec3> const& positions)
        : links_(beads.links),
          model_(calvados2_model(spec, beads)),
          platform_(choose_platform(spec, beads, communicator, run.device)),
          integrator_(run.temperature, run.friction, run.step) {
        hold(links);
        platform_.properties.erase("DeterministicForces");  // OpenMM with its default settings
        integrator_.setRandomNumberSeed(static_cast<int>(run.seed));
        context_ = std::make_unique<OpenMM::Context>(*model_.system, integrator_,
                                                     *platform_.platform, platform_.properties);
        std::vector<OpenMM::Vec3> x;
        for (Vec3 const& each : positions) x.emplace_back(each[0], each[1], each[2]);
        context_->setPositions(x);
        context_->setVelocitiesToTemperature(run.temperature, static_cast<int>(run.seed));
    }
    void step(int steps) override {
        integrator_.step(steps);
        // Waits: the kinetic energy is available only after the last step.
        context_->getState(OpenMM::State::Energy, false, no_force);
    }
    double energy() override {
        return context_->getState(OpenMM::State::Energy).getPotentialEnergy();
    }
    double kinetic_energy() override {
        return context_->getState(OpenMM::State::Energy, false, no_force).getKineticEnergy();
    }
    std::vector<Vec3> positions() override {
        OpenMM::State const state = context_->getState(OpenMM::State::Positions);
        std::vector<Vec3> x;
        x.reserve(state.getPositions().size());
        for (OpenMM::Vec3 const& each : state.getPositions())
            x.push_back({each[0], each[1], each[2]});
        return x;
    }
    double link_error() override { return catena::link_error(links_, positions()); }
    std::string platform() const override { return platform_.name(); }

  private:
    /// Adds the links to the System, as bonds or constraints.
    void hold(OwnLinks links) {
        auto bonds = std::make_unique<OpenMM::HarmonicBondForce>();
        for (auto const& link : links_) {
            int const a = static_cast<int>(link.inboard), b = static_cast<int>(link.outboard);
            if (links == OwnLinks::constraints)
                model_.system->addConstraint(a, b, link.length);
            else
                bonds->addBond(a, b, link.length, calvados2::bond_stiffness);
        }
        if (links == OwnLinks::constraints) return;
        bonds->setForceGroup(model_.system->getNumForces());
        bonds->setUsesPeriodicBoundaryConditions(model_.system->usesPeriodicBoundaryConditions());
        model_.system->addForce(bonds.release());
    }

    std::vector<BeadSystem::Link> links_;
    OpenMmModel model_;
    OpenMmPlatform platform_;
    OpenMM::LangevinMiddleIntegrator integrator_;
    std::unique_ptr<OpenMM::Context> context_;
};

}  // namespace

std::unique_ptr<OpenMmIntegrator> make_openmm_integrator(OpenMmSpec const& spec,
                                                         BeadSystem const& beads,
                                                         Communicator const& communicator,
                                                         OwnLinks links, OwnRun const& run,
                                                         std::vector<Vec3> const& positions) {
    if (beads.replicas > 1)
        throw InputError("OpenMM's own integrator does not keep replicas apart",
                         beads.scene_file + ": replicas",
                         "leave it out; `catena bench sampling --copies N` repeats a chain");
    return std::make_unique<Own>(spec, beads, communicator, links, run, positions);
}

}  // namespace catena
