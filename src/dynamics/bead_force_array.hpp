// Force array of chains of point beads of a group, in any Space.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dynamics/bead_forces.hpp"
#include "dynamics/bead_term.hpp"
#include "dynamics/beads_in.hpp"
#include "dynamics/body_loads.hpp"

namespace catena {

/// The force array of a group's beads, and the forces that its first reader adds to it. All members
/// are public because nvcc accepts kernels in public members only.
template <class Space, class Fields>
struct BeadForceArray {
    BeadsIn<Space, Fields>& beads;
    BodyLoads given;
    /// Constant forces of all terms in the memory of the Space; absent if no bead has one.
    std::optional<typename Space::template Fixed<3>> constant;
    /// Terms that act on single beads; only the host has any.
    std::vector<std::unique_ptr<BeadTerm>> terms;
    /// Forces that are not yet in the array.
    std::optional<BeadForces> pending;
    /// The host's copy of the forces, which it may have changed.
    std::optional<View<3>> shown;
    typename Space::template Mirror<3> mirror;

    /// The beads must outlive this object.
    BeadForceArray(BeadsIn<Space, Fields>& of, Scene const& scene)
        : beads(of), given(make_body_loads(of.group, scene)) {
        if (given.wrenches) constant.emplace(given.wrench_force);
    }

    /// Sets gravity, the constant forces and those of the terms at the last updated configuration.
    /// Collective.
    void set_simple() {
        pending = BeadForces{given.gravity, constant ? constant->view() : ConstView<3>{}, {}};
        if (terms.empty()) return;
        settle();
        for (auto const& term : terms)
            term->add_forces(beads.store.directions(), beads.store.force.view());
    }
    /// Sums the pending forces into the force array; every reader of that array calls it first.
    void settle() {
        if (auto const forces = std::exchange(pending, std::nullopt))
            beads.each_bead([c = beads.chains(), f = *forces] CATENA_LAMBDA(std::int64_t k) {
                c.take_forces(k, f);
            });
    }
    /// Returns the force array for the host, which may change it until take_back().
    View<3> show() {
        settle();
        shown = beads.space.pull(beads.store.force, mirror);
        return *shown;
    }
    void take_back() {
        if (std::exchange(shown, std::nullopt)) beads.space.push(beads.store.force, mirror);
    }
    /// Potential energy at the current positions. Collective.
    PotentialEnergy potential() {
        // OpenMM's energy computation overwrites its forces, so sum them first.
        settle();
        ChainGroup const& group = beads.group;
        auto const& position = beads.space.read(beads.store.position);
        PotentialEnergy energy = potential_of(given, group.size, [&](std::int64_t k) {
            return terms::PlacedBody{k, group.bodies.mass.view().at(k, 0), position[k]};
        });
        for (auto const& term : terms) term->set_energy(energy);
        return energy;
    }
};

}  // namespace catena
