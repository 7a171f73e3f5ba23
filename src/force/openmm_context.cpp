#include "force/openmm_context.hpp"

#include <algorithm>
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
    : box_(box),
      placement_(placement_for(*system)),
      system_(std::move(system)),
      evaluations_(platform.name() == "Reference" ? on_reference : evaluations_of_a_place) {
    context_.reset(home ? impl_of(home->context()).createLinkedContext(*system_, integrator_)
                        : new OpenMM::Context(*system_, integrator_, *platform.platform, platform.properties));
    positions_.resize(static_cast<std::size_t>(system_->getNumParticles()));
}

void ForceContext::find_places(std::span<Vec3 const> positions, std::size_t centred) {
    Vec3 origin = Vec3::zero();
    if (placement_ == Placement::shifted && centred > 0) {
        for (std::size_t i = 0; i < centred; ++i) origin = origin + positions[i];
        origin = (1.0 / static_cast<double>(centred)) * origin;
    }
    place_.assign(positions.size(), origin);
    if (placement_ != Placement::wrapped) return;
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int c = 0; c < 3; ++c) place_[i][c] = (*box_)[c] * std::floor(positions[i][c] / (*box_)[c]);
}

/// Half an edge out of the box: a bead moves less meanwhile, but its particle may be another bead's now.
bool ForceContext::has_strayed(OpenMM::Vec3 const& x) const {
    for (int c = 0; c < 3; ++c)
        if (std::abs(x[c] - (*box_)[c] / 2) > (*box_)[c]) return true;
    return false;
}

void ForceContext::set_positions(std::span<Vec3 const> positions, std::size_t centred) {
    auto const place = [&] {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            Vec3 const x = positions[i] - place_[i];
            positions_[i] = {x[0], x[1], x[2]};
        }
    };
    bool const anew = placed_for_ == 0;
    if (anew) find_places(positions, centred);
    place();
    if (!anew && placement_ == Placement::wrapped &&
        std::any_of(positions_.begin(), positions_.end(), [&](OpenMM::Vec3 const& x) { return has_strayed(x); })) {
        placed_for_ = 0;
        find_places(positions, centred);
        place();
    }
    placed_for_ = (placed_for_ + 1) % evaluations_;
    context_->setPositions(positions_);
}

std::vector<OpenMM::Vec3> ForceContext::forces() { return context_->getState(OpenMM::State::Forces).getForces(); }

void ForceContext::find_energies(std::span<double> of_group) {
    for (int i = 0; i < system_->getNumForces(); ++i) {
        int const group = system_->getForce(i).getForceGroup();
        of_group[static_cast<std::size_t>(group)] = context_->getState(OpenMM::State::Energy, false, 1 << group).getPotentialEnergy();
    }
}

}  // namespace catena
