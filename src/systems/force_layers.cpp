// Implements the choice of layers by an estimate of the number of pairs.
#include "systems/force_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include "systems/force_ranges.hpp"
#include "systems/subset.hpp"

namespace catena {
namespace {

using OpenMM::CustomNonbondedForce;

/// Removable forces of one cutoff, and the particles that act in at least one of them.
struct Candidate {
    /// Indices of the forces in the System.
    std::vector<int> forces;
    /// Flag per particle: 1 if it acts in at least one of the forces.
    std::vector<char> acts;

    /// Number of acting particles.
    double count() const { return static_cast<double>(std::count(acts.begin(), acts.end(), 1)); }
};

/// True if the force may move into a layer of its own, see take_layers().
bool can_be_taken(OpenMM::Force const& force, int particles) {
    auto const* const pairs = dynamic_cast<CustomNonbondedForce const*>(&force);
    return pairs && pairs->getNumParticles() == particles && std::isfinite(reach_of(force)) &&
           pairs->getNumInteractionGroups() == 0 && !pairs->getUseLongRangeCorrection();
}

/// Candidates by their cutoff, the longest first. A candidate must have a longer cutoff than all
/// forces that cannot move.
std::map<double, Candidate, std::greater<>> candidates(OpenMM::System const& system) {
    std::map<double, Candidate, std::greater<>> found;
    double others = 0;
    for (int i = 0; i < system.getNumForces(); ++i) {
        OpenMM::Force const& force = system.getForce(i);
        if (!can_be_taken(force, system.getNumParticles())) {
            others = std::max(others, reach_of(force));
            continue;
        }
        std::vector<char> const acts = acting_particles(force);
        Candidate& candidate =
            found.try_emplace(reach_of(force), Candidate{{}, std::vector<char>(acts.size(), 0)})
                .first->second;
        candidate.forces.push_back(i);
        for (std::size_t p = 0; p < acts.size(); ++p)
            candidate.acts[p] = std::max(candidate.acts[p], acts[p]);
    }
    found.erase(found.upper_bound(others), found.end());
    if (auto const as_far = found.find(others); as_far != found.end()) found.erase(as_far);
    return found;
}

/// Returns the number of candidates to move: the one with the fewest pairs in all Contexts, if
/// particles had a uniform density. Pairs are proportional to n^2 r^3 for n particles and cutoff r.
std::size_t best(std::map<double, Candidate, std::greater<>> const& found,
                 OpenMM::System const& system, double most_pairs) {
    auto const pairs = [](double count, double reach) {
        return count * count * reach * reach * reach;
    };
    double const all = system.getNumParticles();
    double reach_of_others = 0;
    for (int i = 0; i < system.getNumForces(); ++i)
        if (!can_be_taken(system.getForce(i), system.getNumParticles()))
            reach_of_others = std::max(reach_of_others, reach_of(system.getForce(i)));
    std::size_t taken = 0, least_taken = 0;
    double of_taken = 0, least = most_pairs * pairs(all, reach_of(system));
    for (auto candidate = found.begin(); candidate != found.end();) {
        of_taken += pairs(candidate->second.count(), candidate->first);
        double const next = ++candidate == found.end() ? 0 : candidate->first,
                     sum = of_taken + pairs(all, std::max(next, reach_of_others));
        ++taken;
        if (sum < least) {
            least = sum;
            least_taken = taken;
        }
    }
    return least_taken;
}

/// Returns the given beads alone, renumbered from 0 in ascending order.
BeadSystem beads_of(std::vector<std::int64_t> const& bead, BeadSystem const& all) {
    BeadSystem some;
    std::vector<std::int64_t> number(static_cast<std::size_t>(all.size()), -1);
    for (std::size_t i = 0; i < bead.size(); ++i)
        number[static_cast<std::size_t>(bead[i])] = static_cast<std::int64_t>(i);
    auto const before = [&](std::int64_t b) {
        return std::lower_bound(bead.begin(), bead.end(), b) - bead.begin();
    };
    for (std::int64_t const b : bead) some.mass.push_back(all.mass[static_cast<std::size_t>(b)]);
    for (std::int64_t const offset : all.chain_offset) some.chain_offset.push_back(before(offset));
    some.first_of_rank.push_back(0);
    for (int rank = 0; rank + 1 < static_cast<int>(all.first_of_rank.size()); ++rank) {
        for (std::int64_t const b : all.beads_of(rank))
            if (number[static_cast<std::size_t>(b)] >= 0)
                some.by_rank.push_back(number[static_cast<std::size_t>(b)]);
        some.first_of_rank.push_back(static_cast<std::int64_t>(some.by_rank.size()));
    }
    if (all.by_rank.empty()) some.by_rank.clear();
    for (std::int64_t const b : bead) some.number.push_back(all.name(b));
    some.replicas = all.replicas;
    some.box = all.box;
    some.scene_file = all.scene_file;
    some.threads = all.threads;
    return some;
}

/// Makes the layer of a candidate: its System, its beads and the names of its terms.
ForceLayer layer_of(Candidate const& candidate, OpenMmModel const& model, BeadSystem const& beads) {
    ForceLayer layer;
    Subset subset;
    for (int p = 0; p < model.system->getNumParticles(); ++p)
        if (candidate.acts[static_cast<std::size_t>(p)] != 0) subset.particles.push_back(p);
    subset.own = subset.fixed = static_cast<int>(subset.particles.size());
    for (int const p : subset.particles)
        layer.bead.push_back(model.bead_of_particle[static_cast<std::size_t>(p)]);
    std::vector<std::int64_t> const of_particle = layer.bead;
    std::sort(layer.bead.begin(), layer.bead.end());
    layer.beads = beads_of(layer.bead, beads);
    layer.model.system = system_of(subset, *model.system, candidate.forces);
    for (std::int64_t const bead : of_particle)
        layer.model.bead_of_particle.push_back(
            std::lower_bound(layer.bead.begin(), layer.bead.end(), bead) - layer.bead.begin());
    for (int const force : candidate.forces)
        layer.model.terms.push_back(
            model.terms[static_cast<std::size_t>(model.system->getForce(force).getForceGroup())]);
    return layer;
}

}  // namespace

std::vector<ForceLayer> take_layers(OpenMmModel& model, BeadSystem const& beads,
                                    double most_pairs) {
    std::vector<ForceLayer> layers;
    for (int i = 0; i < model.system->getNumForces(); ++i)
        if (!can_be_split(model.system->getForce(i))) return layers;
    auto found = candidates(*model.system);
    std::size_t const count = best(found, *model.system, most_pairs);
    std::vector<int> taken;
    for (auto candidate = found.begin();
         candidate != std::next(found.begin(), static_cast<std::ptrdiff_t>(count)); ++candidate) {
        if (candidate->second.count() > 0)
            layers.push_back(layer_of(candidate->second, model, beads));
        taken.insert(taken.end(), candidate->second.forces.begin(), candidate->second.forces.end());
    }
    std::sort(taken.begin(), taken.end(), std::greater<>());
    for (int const force : taken) model.system->removeForce(force);
    return layers;
}

void hold_chains_together(ForceLayer& layer) {
    OpenMM::System& system = *layer.model.system;
    auto bonds = std::make_unique<OpenMM::CustomBondForce>("0");
    bonds->setForceGroup(system.getForce(0).getForceGroup());
    bonds->setUsesPeriodicBoundaryConditions(system.usesPeriodicBoundaryConditions());
    std::vector<int> const particle = particles_of_beads(layer.model.bead_of_particle);
    std::vector<std::int64_t> const& offset = layer.beads.chain_offset;
    for (std::size_t chain = 0; chain + 1 < offset.size(); ++chain)
        for (std::int64_t bead = offset[chain] + 1; bead < offset[chain + 1]; ++bead)
            bonds->addBond(particle[static_cast<std::size_t>(bead - 1)],
                           particle[static_cast<std::size_t>(bead)]);
    system.addForce(bonds.release());
}

std::vector<std::int64_t> own_places(ForceLayer const& layer, BeadSystem const& all, int rank) {
    std::vector<std::int64_t> places;
    std::vector<std::int64_t> const own = all.beads_of(rank);
    for (std::size_t k = 0; k < own.size(); ++k)
        if (std::binary_search(layer.bead.begin(), layer.bead.end(), own[k]))
            places.push_back(static_cast<std::int64_t>(k));
    return places;
}

std::vector<int> particles_in(ForceLayer const& layer, OpenMmModel const& model) {
    std::vector<int> const particle_of_bead = particles_of_beads(model.bead_of_particle);
    std::vector<int> particles;
    for (std::int64_t const bead : layer.model.bead_of_particle)
        particles.push_back(
            particle_of_bead[static_cast<std::size_t>(layer.bead[static_cast<std::size_t>(bead)])]);
    return particles;
}

std::string text_of(ForceLayer const& layer, BeadSystem const& all) {
    return fmt::format("{} in a Context of its own: it acts on {} of {} beads, up to {:g} nm",
                       fmt::join(layer.model.terms, ", "), layer.beads.size(), all.size(),
                       reach_of(*layer.model.system));
}

}  // namespace catena
