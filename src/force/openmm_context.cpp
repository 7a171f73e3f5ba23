#include "force/openmm_context.hpp"

#include <cmath>
#include <utility>

#include "force/openmm_impl.hpp"
#include "force/openmm_subset.hpp"

namespace catena {
Placement placement_for(OpenMM::System const& system) {
    bool images = system.usesPeriodicBoundaryConditions();
    for (int i = 0; i < system.getNumForces(); ++i) {
        OpenMM::Force const& force = system.getForce(i);
        if (!can_be_split(force) && dynamic_cast<OpenMM::NonbondedForce const*>(&force) == nullptr) return Placement::as_given;
        if (dynamic_cast<OpenMM::CustomExternalForce const*>(&force) != nullptr) return Placement::as_given;
        images = images && force.usesPeriodicBoundaryConditions();
        if (auto const* pairs = dynamic_cast<OpenMM::NonbondedForce const*>(&force))
            images = images && (pairs->getNumExceptions() == 0 || pairs->getExceptionsUsePeriodicBoundaryConditions());
    }
    return images ? Placement::wrapped : Placement::shifted;
}

ForceContext::ForceContext(std::shared_ptr<OpenMM::System const> system, OpenMmPlatform const& platform, std::optional<Vec3> const& box,
                           ForceContext* home)
    : box_(box), placement_(placement_for(*system)), system_(std::move(system)) {
    context_.reset(home ? impl_of(home->context()).createLinkedContext(*system_, integrator_)
                        : new OpenMM::Context(*system_, integrator_, *platform.platform, platform.properties));
    positions_.resize(static_cast<std::size_t>(system_->getNumParticles()));
}

void ForceContext::set_positions(std::span<Vec3 const> positions, std::size_t centred) {
    Vec3 origin = Vec3::zero();
    if (placement_ == Placement::shifted && centred > 0) {
        for (std::size_t i = 0; i < centred; ++i) origin = origin + positions[i];
        origin = (1.0 / static_cast<double>(centred)) * origin;
    }
    for (std::size_t i = 0; i < positions.size(); ++i) {
        Vec3 x = positions[i] - origin;
        if (placement_ == Placement::wrapped)
            for (int c = 0; c < 3; ++c) x[c] -= (*box_)[c] * std::floor(x[c] / (*box_)[c]);
        positions_[i] = {x[0], x[1], x[2]};
    }
    context_->setPositions(positions_);
}

std::vector<OpenMM::Vec3> ForceContext::forces() { return context_->getState(OpenMM::State::Forces).getForces(); }

double ForceContext::energy(int group) { return context_->getState(OpenMM::State::Energy, false, 1 << group).getPotentialEnergy(); }

}  // namespace catena
