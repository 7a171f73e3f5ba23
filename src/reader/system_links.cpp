// Implements the links of written chains by the System's bonds and constraints. Particles of a
// chain are consecutive, so that bead k of a chain is particle `first` + k. Links of a branched
// chain join particles that need not be consecutive.
#include "reader/system_links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader/force_notes.hpp"
#include "scene/bead_links.hpp"
#include "scene/force_changes.hpp"

namespace catena::scene {

namespace {

/// Difference of lengths, relative to that of the bond, that is noted.
double constexpr noted_difference = 0.02;
/// Links of a draft between beads. A ring's closing link may still lack the length, which is then
/// the distance at the start.
std::vector<BeadLink> links_of(ChainSpec const& chain) {
    std::vector<BeadLink> links = bead_links(chain);
    for (BeadLink& link : links)
        if (link.length == 0 && chain.is_beads())
            link.length = norm(chain.beads.position[static_cast<std::size_t>(link.outboard)] -
                               chain.beads.position[static_cast<std::size_t>(link.inboard)]);
    return links;
}

/// True if a rigid body of the chain carries both beads.
bool share_body(ChainSpec const& chain, std::int64_t a, std::int64_t b) {
    std::vector<std::int64_t> const& offset = chain.linked.carried.offset;
    return chain.is_linked() && std::upper_bound(offset.begin(), offset.end(), a) ==
                                    std::upper_bound(offset.begin(), offset.end(), b);
}

/// Counts links of one kind and keeps the first.
struct DoubtfulLinks {
    std::int64_t count = 0;
    std::string chain;  // of the first
    std::int64_t inboard = 0, outboard = 0;
    double length = 0, bond = 0;  // nm

    void add(ChainSpec const& of, BeadLink const& link, double bond_length = 0) {
        if (count++ > 0) return;
        chain = of.name, inboard = link.inboard, outboard = link.outboard;
        length = link.length, bond = bond_length;
    }
    /// Adds the links of one more chain.
    void add(DoubtfulLinks const& more) {
        std::int64_t const before = count;
        if (before == 0) *this = more;
        count = before + more.count;
    }
    /// The first link's beads, counted from 1, with their chain.
    std::string first() const {
        return fmt::format("beads {} and {} of chain `{}`", inboard + 1, outboard + 1,
                           shown(chain));
    }
};

/// Number of bonds between particles of a draft that no link joins. Those within a rigid body do
/// not count.
std::int64_t off_links(Draft const& draft, std::vector<BeadLink> const& links,
                       std::set<std::pair<std::int64_t, std::int64_t>> const& bonds) {
    std::set<std::pair<std::int64_t, std::int64_t>> linked;
    for (BeadLink const& link : links) linked.insert(std::minmax(link.inboard, link.outboard));
    return std::count_if(bonds.begin(), bonds.end(), [&](auto const& bond) {
        std::pair const beads(bond.first - draft.particle, bond.second - draft.particle);
        return !linked.contains(beads) && !share_body(draft.chain, beads.first, beads.second);
    });
}

void note_unbonded(Scene& scene, DoubtfulLinks const& links, std::int64_t all,
                   std::int64_t elsewhere) {
    if (links.count == 0) return;
    scene.note(fmt::format(
        "{} of {} links join{} particles that the System neither bonds nor constrains, the first {}"
        "{}: are `parent` and `map` those of the System?",
        links.count, all, links.count == 1 ? "s" : "", links.first(),
        elsewhere == 0 ? ""
                       : fmt::format(", and {} of its bonds within these chains {} along no link",
                                     elsewhere, elsewhere == 1 ? "is" : "are")));
}

void note_lengths(Scene& scene, DoubtfulLinks const& links) {
    if (links.count == 0) return;
    scene.note(
        fmt::format("{} {} at least {:.0f} % longer or shorter than the System's bond, the first "
                    "{}: {:.4g} nm, "
                    "its bond {:.4g} nm: are the lengths and `map` those of the System?",
                    links.count, links.count == 1 ? "link is" : "links are", 100 * noted_difference,
                    links.first(), links.length, links.bond));
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

bool WrittenSystem::bonded(std::int64_t a, std::int64_t b) const {
    std::pair<std::int64_t, std::int64_t> const pair = std::minmax(a, b);
    return between(a, b).holds() ||
           std::binary_search(links_.custom.begin(), links_.custom.end(), pair);
}

std::set<std::pair<std::int64_t, std::int64_t>> WrittenSystem::bonds_within(
    std::int64_t first, std::int64_t last) const {
    std::set<std::pair<std::int64_t, std::int64_t>> bonds;
    for (std::int64_t p = first + 1; p <= last; ++p)
        if (between(p - 1, p).holds()) bonds.emplace(p - 1, p);
    std::pair const from(first, std::int64_t{0});
    for (auto far = links_.farther.lower_bound(from);
         far != links_.farther.end() && far->first.first <= last; ++far)
        if (far->first.second <= last && far->second.holds()) bonds.insert(far->first);
    for (auto pair = std::lower_bound(links_.custom.begin(), links_.custom.end(), from);
         pair != links_.custom.end() && pair->first <= last; ++pair)
        if (pair->second <= last) bonds.insert(*pair);
    return bonds;
}

void WrittenSystem::compare(std::vector<Draft> const& drafts, Scene& scene) const {
    DoubtfulLinks unbonded, other_length;
    std::int64_t links_of_these = 0, bonds_elsewhere = 0;
    for (Draft const& draft : drafts) {
        DoubtfulLinks here;
        std::int64_t bonded_here = 0;
        std::vector<BeadLink> const links = links_of(draft.chain);
        for (BeadLink const& link : links) {
            std::int64_t const a = draft.particle + link.inboard,
                               b = draft.particle + link.outboard;
            bonded(a, b) ? void(++bonded_here) : here.add(draft.chain, link);
            Joining const bond = between(a, b);
            if (bond.holds() && link.length > 0 &&
                std::abs(link.length - bond.length) >= noted_difference * bond.length)
                other_length.add(draft.chain, link, bond.length);
        }
        if (here.count == 0) continue;
        std::int64_t const off = off_links(
            draft, links,
            bonds_within(draft.particle,
                         draft.particle + static_cast<std::int64_t>(draft.chain.bead_count()) - 1));
        // A System may leave all links to the scene, and close rings or cross-link them.
        if (bonded_here == 0 && off < here.count) continue;
        links_of_these += here.count + bonded_here, bonds_elsewhere += off;
        unbonded.add(here);
    }
    note_unbonded(scene, unbonded, links_of_these, bonds_elsewhere);
    note_lengths(scene, other_length);
}

bool WrittenSystem::alike(std::int64_t a, std::int64_t b, std::int64_t beads,
                          Parents parents) const {
    for (std::int64_t k = 1; k < beads; ++k) {
        auto const on = static_cast<std::int64_t>(inboard_of(parents, static_cast<std::size_t>(k)));
        double const one = length(a + on, a + k), other = length(b + on, b + k);
        if (one != other && !(std::isnan(one) && std::isnan(other))) return false;
    }
    return true;
}

void WrittenSystem::judge(std::vector<Draft> const& drafts, Scene& scene) const {
    StiffLinks links(scene.forces.openmm->temperature, openmm_key(scene.file, "system"));
    for (Draft const& draft : drafts)
        for (BeadLink const& link : links_of(draft.chain)) {
            std::int64_t const a = draft.particle + link.inboard,
                               b = draft.particle + link.outboard;
            if (Joining const joining = between(a, b); joining.holds()) links.add(a, b, joining);
        }
    for (std::string const& note : links.notes()) scene.note(note);
    compare(drafts, scene);
    std::vector<std::int64_t> firsts;
    for (Draft const& draft : drafts)
        if (draft.chain.bead_count() > 0) firsts.push_back(draft.particle);
    std::sort(firsts.begin(), firsts.end());
    for (std::string const& note : notes_on_boxless(links_.boxless, firsts)) scene.note(note);
    note_box_that_no_force_knows(scene, links_.periodic);
    note_screening(scene, links_.screening);
}

}  // namespace catena::scene
