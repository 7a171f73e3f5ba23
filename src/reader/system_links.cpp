// Implements the links of written chains by the System's bonds and constraints. Particles of a
// chain are consecutive, so that bead k of a chain is particle `first` + k. Links of a branched
// chain join particles that need not be consecutive.
#include "reader/system_links.hpp"

#include <algorithm>
#include <cmath>

#include "reader/force_notes.hpp"
#include "scene/force_changes.hpp"

namespace catena::scene {

namespace {

/// Beads of a chain (from 0) at the inboard and the outboard ends of links.
std::vector<std::pair<std::int64_t, std::int64_t>> linked_beads(ChainSpec const& chain) {
    std::vector<std::pair<std::int64_t, std::int64_t>> beads;
    if (chain.is_beads())
        for (std::size_t k = 1; k < chain.size(); ++k)
            beads.emplace_back(inboard_of(chain.parent, k), k);
    if (chain.is_linked() && chain.linked.carried.offset.size() == chain.size() + 1)
        for (std::size_t k = 1; k < chain.size(); ++k)
            if (std::int64_t const first = chain.linked.carried.offset[k];
                first > chain.linked.carried.offset[k - 1])
                beads.emplace_back(first - 1, first);
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

Joining WrittenSystem::between(std::int64_t a, std::int64_t b) const {
    std::int64_t const low = std::min(a, b), high = std::max(a, b);
    if (low < 0 || high >= std::ssize(links_.to_previous)) return {};
    if (high - low == 1) return links_.to_previous[static_cast<std::size_t>(high)];
    auto const found = links_.farther.find({low, high});
    return found == links_.farther.end() ? Joining{} : found->second;
}

double WrittenSystem::largest_spread(std::int64_t first, std::int64_t beads,
                                     Parents parents) const {
    double largest = 0;
    for (std::int64_t k = 1; k < beads; ++k) {
        auto const inboard =
            static_cast<std::int64_t>(inboard_of(parents, static_cast<std::size_t>(k)));
        if (Joining const joining = between(first + inboard, first + k); joining.holds())
            largest = std::max(largest, joining.spread(temperature_));
    }
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
        for (auto const& [inboard, outboard] : linked_beads(draft.chain)) {
            std::int64_t const a = draft.particle + inboard, b = draft.particle + outboard;
            if (Joining const joining = between(a, b); joining.holds()) links.add(a, b, joining);
        }
    for (std::string const& note : links.notes()) scene.note(note);
    note_box_that_no_force_knows(scene, links_.periodic);
    note_screening(scene, links_.screening);
}

}  // namespace catena::scene
