// Implements the links of written chains by the System's bonds and constraints. Particles of a
// chain are consecutive, so that bead k of a chain is particle `first` + k.
#include "reader/system_links.hpp"

#include <algorithm>
#include <cmath>

#include "reader/force_notes.hpp"
#include "scene/force_changes.hpp"

namespace catena::scene {

namespace {

/// Beads of a chain (from 0) at the outboard ends of links.
std::vector<std::int64_t> linked_beads(ChainSpec const& chain) {
    std::vector<std::int64_t> beads;
    if (chain.is_beads())
        for (std::size_t k = 1; k < chain.size(); ++k)
            beads.push_back(static_cast<std::int64_t>(k));
    if (chain.is_linked() && chain.linked.carried.offset.size() == chain.size() + 1)
        for (std::size_t k = 1; k < chain.size(); ++k)
            if (std::int64_t const first = chain.linked.carried.offset[k];
                first > chain.linked.carried.offset[k - 1])
                beads.push_back(first);
    return beads;
}

}  // namespace

WrittenSystem::WrittenSystem(Scene& scene)
    : links_(read_system_links(*scene.forces.openmm, scene.file)),
      temperature_(scene.forces.openmm->temperature) {
    for (std::string const& note : links_.notes) scene.note(note);
    for (auto const& [chain, particles] : chain_map(*scene.forces.openmm))
        first_.emplace(chain, particles.first);
}

std::int64_t WrittenSystem::first_particle(std::string const& chain, std::int64_t next) const {
    auto const entry = first_.find(chain);
    return entry == first_.end() ? next : entry->second;
}

double WrittenSystem::length(std::int64_t particle) const {
    bool const known = particle >= 0 && particle < std::ssize(links_.to_previous);
    return known ? links_.to_previous[static_cast<std::size_t>(particle)].length : Joining{}.length;
}

double WrittenSystem::largest_spread(std::int64_t first, std::int64_t beads) const {
    double largest = 0;
    for (std::int64_t p = first + 1; p < std::min(first + beads, std::ssize(links_.to_previous));
         ++p)
        if (Joining const& joining = links_.to_previous[static_cast<std::size_t>(p)];
            joining.holds())
            largest = std::max(largest, joining.spread(temperature_));
    return largest;
}

bool WrittenSystem::alike(std::int64_t a, std::int64_t b, std::int64_t beads) const {
    for (std::int64_t k = 1; k < beads; ++k) {
        double const one = length(a + k), other = length(b + k);
        if (one != other && !(std::isnan(one) && std::isnan(other))) return false;
    }
    return true;
}

void WrittenSystem::judge(std::vector<Draft> const& drafts, Scene& scene) const {
    StiffLinks links(scene.forces.openmm->temperature, openmm_key(scene.file, "system"));
    for (Draft const& draft : drafts)
        for (std::int64_t const k : linked_beads(draft.chain)) {
            std::int64_t const p = draft.particle + k;
            if (p < std::ssize(links_.to_previous) &&
                links_.to_previous[static_cast<std::size_t>(p)].holds())
                links.add(p - 1, p, links_.to_previous[static_cast<std::size_t>(p)]);
        }
    for (std::string const& note : links.notes()) scene.note(note);
    note_box_that_no_force_knows(scene, links_.periodic);
    note_screening(scene, links_.screening);
}

}  // namespace catena::scene
