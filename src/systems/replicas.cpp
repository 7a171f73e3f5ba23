// Implements the repetition of one replica's System.
#include "systems/replicas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>

#include "error.hpp"
#include "systems/subset.hpp"

namespace catena {
namespace {

/// Range of beads [begin, end).
struct Range {
    std::int64_t begin, end;
    bool has(std::int64_t bead) const { return bead >= begin && bead < end; }
};

/// Returns the elements of a range.
template <class T>
std::vector<T> slice(std::vector<T> const& all, Range const& range) {
    return {all.begin() + range.begin, all.begin() + range.end};
}

/// Returns the beads of `count` replicas from `first` on, numbered from 0, as those of one rank.
BeadSystem some_replicas(BeadSystem const& all, std::int64_t first, std::int64_t count) {
    std::int64_t const n = all.beads_a_replica();
    Range const range{first * n, (first + count) * n};
    auto const chains = static_cast<std::int64_t>(all.chain_name.size()) / all.replicas;
    BeadSystem some;
    some.mass = slice(all.mass, range);
    some.residue = slice(all.residue, range);
    some.chain_name = slice(all.chain_name, {first * chains, (first + count) * chains});
    for (std::int64_t c = first * chains; c <= (first + count) * chains; ++c)
        some.chain_offset.push_back(all.chain_offset[static_cast<std::size_t>(c)] - range.begin);
    for (auto const& link : all.links)
        if (range.has(link.inboard))
            some.links.push_back(
                {link.inboard - range.begin, link.outboard - range.begin, link.length});
    for (auto const& [a, b] : all.neighbours)
        if (range.has(a)) some.neighbours.emplace_back(a - range.begin, b - range.begin);
    for (auto const& [a, b] : all.rigid)
        if (range.has(a)) some.rigid.emplace_back(a - range.begin, b - range.begin);
    some.first_of_rank = {0, some.size()};
    some.box = all.box;
    some.scene_file = all.scene_file;
    some.threads = all.threads;
    some.replicas = count;
    return some;
}

/// True if an energy expression uses a coordinate such as x1, not distances and angles alone.
bool names_a_coordinate(std::string_view energy) {
    auto const is_part = [&](std::size_t i) {
        return i < energy.size() &&
               (std::isalnum(static_cast<unsigned char>(energy[i])) != 0 || energy[i] == '_');
    };
    for (std::size_t i = 0; i < energy.size();) {
        std::size_t end = i;
        while (is_part(end)) ++end;
        std::string_view const word = energy.substr(i, end - i);
        if (word.size() > 1 && (word[0] == 'x' || word[0] == 'y' || word[0] == 'z') &&
            std::all_of(word.begin() + 1, word.end(),
                        [](unsigned char c) { return std::isdigit(c) != 0; }))
            return true;
        i = end + 1;
    }
    return false;
}

/// True if the force depends on places in the ground's frame, which replicas do not keep.
bool knows_places(OpenMM::Force const& force) {
    if (dynamic_cast<OpenMM::CustomExternalForce const*>(&force) != nullptr) return true;
    if (auto const* bonds = dynamic_cast<OpenMM::CustomCompoundBondForce const*>(&force))
        return names_a_coordinate(bonds->getEnergyFunction());
    if (auto const* bonds = dynamic_cast<OpenMM::CustomCentroidBondForce const*>(&force))
        return names_a_coordinate(bonds->getEnergyFunction());
    return false;
}

/// Returns why a force cannot act in each of several replicas; empty if it can.
std::string why_not_repeated(OpenMM::Force const& force) {
    if (!can_be_split(force)) return "acts on all particles at once";
    if (knows_places(force)) return "depends on places in space, which replicas do not share";
    if (force.usesPeriodicBoundaryConditions()) return "is periodic";
    if (std::isinf(reach_of(force)))
        return "has no cutoff, so that replicas would act on each other";
    return {};
}

}  // namespace

BeadSystem first_replica(BeadSystem const& beads) {
    BeadSystem one = some_replicas(beads, 0, 1);
    std::string_view constexpr suffix = "-1";
    for (std::string& name : one.chain_name)
        if (beads.replicas > 1 && name.ends_with(suffix)) name.resize(name.size() - suffix.size());
    return one;
}

BeadSystem replicas_of_rank(BeadSystem const& beads, int rank, int ranks) {
    std::int64_t const own = beads.replicas / ranks, n = beads.beads_a_replica();
    std::vector<std::int64_t> of_rank;
    for (int r = 0; r < ranks; ++r) {
        std::vector<std::int64_t> order = beads.beads_of(r);
        std::vector<std::int64_t> sorted = order, whole(static_cast<std::size_t>(own * n));
        std::sort(sorted.begin(), sorted.end());
        std::iota(whole.begin(), whole.end(), r * own * n);
        if (sorted != whole)
            throw InputError(
                fmt::format("{} replicas do not go into {} ranks", beads.replicas, ranks),
                beads.scene_file + ": replicas",
                "use a number of ranks that divides the number of replicas");
        if (r == rank) of_rank = std::move(order);
    }
    BeadSystem some = some_replicas(beads, rank * own, own);
    for (std::int64_t& bead : of_rank) bead -= rank * own * n;
    if (!std::is_sorted(of_rank.begin(), of_rank.end())) some.by_rank = std::move(of_rank);
    some.number.resize(static_cast<std::size_t>(some.size()));
    std::iota(some.number.begin(), some.number.end(), rank * own * n);
    return some;
}

void repeat_model(OpenMmModel& model, BeadSystem const& one, std::int64_t replicas) {
    OpenMM::System const& system = *model.system;
    for (int i = 0; i < system.getNumForces(); ++i)
        if (std::string const why = why_not_repeated(system.getForce(i)); !why.empty())
            throw InputError(
                fmt::format("the force {} {}", model.terms[static_cast<std::size_t>(i)], why),
                one.scene_file + ": replicas",
                "leave `replicas` out and run the scene with several seeds");
    Subset all;
    all.particles.resize(static_cast<std::size_t>(system.getNumParticles()));
    std::iota(all.particles.begin(), all.particles.end(), 0);
    all.own = all.fixed = system.getNumParticles();
    all.repetitions = static_cast<int>(replicas);
    model.system = system_of(all, system);
    std::vector<std::int64_t> const of_one = model.bead_of_particle;
    for (std::int64_t r = 1; r < replicas; ++r)
        for (std::int64_t const bead : of_one)
            model.bead_of_particle.push_back(bead + r * one.size());
    model.notes.insert(model.notes.begin(),
                       fmt::format("{} replicas without forces between them; links, bodies and "
                                   "charges are those of each one",
                                   replicas));
}

}  // namespace catena
