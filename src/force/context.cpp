// Placement of particles and evaluation of forces and energies in one OpenMM Context.
#include "force/context.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "force/openmm_impl.hpp"
#include "systems/subset.hpp"

namespace catena {
namespace {

/// Returns the mean of the positions.
Vec3 middle_of(std::span<Vec3 const> positions) {
    Vec3 sum = Vec3::zero();
    for (Vec3 const& x : positions) sum = sum + x;
    return (1.0 / static_cast<double>(positions.size())) * sum;
}

/// True if the energy may depend on coordinates, not only on distances.
bool may_know_places(OpenMM::Force const& force) {
    return dynamic_cast<OpenMM::CustomExternalForce const*>(&force) != nullptr ||
           dynamic_cast<OpenMM::CustomCompoundBondForce const*>(&force) != nullptr ||
           dynamic_cast<OpenMM::CustomCentroidBondForce const*>(&force) != nullptr;
}

}  // namespace

Placement placement_for(OpenMM::System const& system) {
    bool images = system.usesPeriodicBoundaryConditions();
    for (int i = 0; i < system.getNumForces(); ++i) {
        OpenMM::Force const& force = system.getForce(i);
        if (!can_be_split(force) && dynamic_cast<OpenMM::NonbondedForce const*>(&force) == nullptr)
            return Placement::as_given;
        if (may_know_places(force)) return Placement::as_given;
        images = images && force.usesPeriodicBoundaryConditions();
        if (auto const* pairs = dynamic_cast<OpenMM::NonbondedForce const*>(&force))
            images = images && (pairs->getNumExceptions() == 0 ||
                                pairs->getExceptionsUsePeriodicBoundaryConditions());
    }
    return images ? Placement::wrapped : Placement::shifted;
}

Placement placement_for(std::span<std::shared_ptr<OpenMM::System const> const> systems) {
    std::optional<Placement> common;
    for (auto const& system : systems)
        if (system->getNumForces() > 0)
            common = std::min(common.value_or(Placement::wrapped), placement_for(*system));
    return common.value_or(Placement::shifted);
}

ForceContext::ForceContext(std::shared_ptr<OpenMM::System const> system,
                           OpenMmPlatform const& platform, std::optional<Vec3> const& box,
                           ForceContext* home)
    : box_(box),
      placement_(placement_for(*system)),
      system_(std::move(system)),
      evaluations_(platform.name() == "Reference" ? on_reference : evaluations_of_a_place) {
    context_.reset(
        home ? impl_of(home->context()).createLinkedContext(*system_, integrator_)
             : new OpenMM::Context(*system_, integrator_, *platform.platform, platform.properties));
    positions_.resize(static_cast<std::size_t>(system_->getNumParticles()));
}

void ForceContext::find_places(std::span<Vec3 const> positions, std::size_t centred) {
    if (!replicas_.empty()) {
        replicas_.find(positions);
        place_.resize(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) place_[i] = replicas_.shift(i);
        return;
    }
    bool const shifted = placement_ == Placement::shifted && centred > 0;
    place_.assign(positions.size(), shifted ? middle_of(positions.first(centred)) : Vec3::zero());
    if (placement_ != Placement::wrapped) return;
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int c = 0; c < 3; ++c)
            place_[i][c] = (*box_)[c] * std::floor(positions[i][c] / (*box_)[c]);
}

/// Beads move far less than these limits in a time step. They exceed them if a state has been set,
/// or the frame of another copy.
bool ForceContext::have_strayed(std::span<Vec3 const> positions, std::size_t centred) const {
    if (!replicas_.empty()) return !replicas_.hold(positions);
    // Single precision resolves 1e-6 nm up to 16 nm from the origin, but only 6e-5 nm at 1000 nm.
    double constexpr farthest = 10;
    if (placement_ == Placement::shifted)
        return centred > 0 && norm(middle_of(positions.first(centred)) - place_.front()) > farthest;
    if (placement_ == Placement::as_given) return false;
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (std::abs(positions[i][c] - place_[i][c] - (*box_)[c] / 2) > (*box_)[c])
                return true;  // half an edge outside the box
    return false;
}

void ForceContext::set_positions(std::span<Vec3 const> positions, std::size_t centred) {
    if (placed_for_ == 0 || have_strayed(positions, centred)) {
        placed_for_ = 0;
        find_places(positions, centred);
    }
    for (std::size_t i = 0; i < positions.size(); ++i) {
        Vec3 const x = positions[i] - place_[i];
        positions_[i] = {x[0], x[1], x[2]};
    }
    placed_for_ = (placed_for_ + 1) % evaluations_;
    context_->setPositions(positions_);
}

std::vector<OpenMM::Vec3> ForceContext::forces(int groups) {
    return context_->getState(OpenMM::State::Forces, false, groups).getForces();
}

void ForceContext::find_energies(std::span<double> of_group, int groups) {
    for (int i = 0; i < system_->getNumForces(); ++i) {
        int const group = system_->getForce(i).getForceGroup();
        if ((groups & 1 << group) == 0) continue;
        groups &= ~(1 << group);  // several forces of a group have one energy
        of_group[static_cast<std::size_t>(group)] =
            context_->getState(OpenMM::State::Energy, false, 1 << group).getPotentialEnergy();
    }
}

}  // namespace catena
