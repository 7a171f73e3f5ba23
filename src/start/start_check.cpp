// Implements the check of a scene's start.
#include "start/start_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "error.hpp"
#include "generate/nearest.hpp"
#include "integrate/scene_beads.hpp"
#include "mpi/first_rank.hpp"
#include "observe/observables.hpp"
#include "start/lone_forces.hpp"

namespace catena {
namespace {

double constexpr most_energy = 10;  // ratio to the thermal kinetic energy: released, such an energy
                                    // heats the chains by this factor
double constexpr thermal_force =
    400;  // kT/nm: five times the thermal force of a stiff bond (spread 0.01 nm)
double constexpr largest_force =
    10'000;  // kT/nm: its work within a thousandth of a nanometre is ten times kT
double constexpr touching = 0.45;         // nm: smallest diameter of a residue's bead
double constexpr coinciding = 0.15;       // nm: forces may not be finite at smaller distances
double constexpr as_near = 1.05;          // ratio to the smallest distance
double constexpr least_distance = 1e-6;   // nm: the cells of the search must have a width
double constexpr straight_within = 1e-6;  // sine of the angle between two links
double constexpr looked_at = 0.7;         // nm: beads further apart do not overlap

/// Returns the pairs of beads that a link or a joint holds together.
std::vector<std::pair<std::int64_t, std::int64_t>> joined_pairs(BeadSystem const& beads) {
    std::vector<std::pair<std::int64_t, std::int64_t>> pairs = beads.neighbours;
    for (auto const& link : beads.links) pairs.emplace_back(link.inboard, link.outboard);
    return pairs;
}

/// Test for pairs that a link, a joint or a body holds together.
class Joined {
  public:
    explicit Joined(BeadSystem const& beads)
        : pairs_(joined_pairs(beads)), body_(static_cast<std::size_t>(beads.size()), -1) {
        std::sort(pairs_.begin(), pairs_.end());
        std::int64_t body = 0;
        for (auto const& [first, end] : beads.rigid) {
            std::fill(body_.begin() + first, body_.begin() + end, body);
            ++body;
        }
    }
    bool operator()(std::size_t a, std::size_t b) const {
        if (body_[a] >= 0 && body_[a] == body_[b]) return true;
        return std::binary_search(
            pairs_.begin(), pairs_.end(),
            std::pair(static_cast<std::int64_t>(a), static_cast<std::int64_t>(b)));
    }

  private:
    std::vector<std::pair<std::int64_t, std::int64_t>> pairs_;  // sorted ascending
    std::vector<std::int64_t> body_;  // index of each bead's rigid body; -1: none
};

/// Returns the chain of a bead and its position in that chain, from 0.
std::pair<std::size_t, std::int64_t> place_of(BeadSystem const& beads, std::size_t bead) {
    auto const number = static_cast<std::int64_t>(bead);
    auto const chain =
        std::upper_bound(beads.chain_offset.begin(), beads.chain_offset.end(), number) -
        beads.chain_offset.begin() - 1;
    return {static_cast<std::size_t>(chain),
            number - beads.chain_offset[static_cast<std::size_t>(chain)]};
}

std::string name_of(BeadSystem const& beads, std::size_t bead) {
    auto const [chain, number] = place_of(beads, bead);
    return fmt::format("bead {} of chain `{}`", number + 1, beads.chain_name[chain]);
}

std::string name_of(BeadSystem const& beads, scene::NearPair const& pair) {
    auto const a = place_of(beads, pair.first), b = place_of(beads, pair.second);
    if (a.first == b.first)
        return fmt::format("beads {} and {} of chain `{}`", a.second + 1, b.second + 1,
                           beads.chain_name[a.first]);
    return name_of(beads, pair.first) + " and " + name_of(beads, pair.second);
}

/// Nearest pair within a distance that neither link, joint nor body holds together.
std::optional<scene::NearPair> nearest_of(Scene const& scene, BeadSystem const& beads,
                                          std::vector<Vec3> const& positions, double within) {
    Joined const joined(beads);
    return scene::nearest_pair(positions, scene.box, within,
                               [&](std::size_t a, std::size_t b) { return !joined(a, b); });
}

/// Returns the pair with the largest forces among those that are as near as the nearest pair,
/// within a few per cent of its distance.
std::optional<scene::NearPair> worst_of(Scene const& scene, BeadSystem const& beads,
                                        std::vector<Vec3> const& positions,
                                        std::vector<Vec3> const& forces) {
    std::optional<scene::NearPair> worst = nearest_of(scene, beads, positions, looked_at);
    if (!worst) return worst;
    Joined const joined(beads);
    double felt = -1;
    double const within = std::max(as_near * worst->distance, least_distance);
    scene::for_each_near_pair(positions, scene.box, within,
                              [&](std::size_t a, std::size_t b, Vec3 const& apart) {
                                  if (joined(a, b)) return;
                                  double const both = norm(forces[a]) + norm(forces[b]);
                                  // `!(<=)` treats forces that are not finite as the largest.
                                  if (!(both <= felt))
                                      worst = scene::NearPair{a, b, norm(apart)}, felt = both;
                              });
    return worst;
}

/// Returns the middle bead of the first two links that share a bead and lie on a line, within the
/// resolution of positions.
std::optional<std::size_t> middle_of_straight(BeadSystem const& beads,
                                              std::vector<Vec3> const& positions) {
    std::vector<std::pair<std::int64_t, std::int64_t>> joined = joined_pairs(beads);
    for (auto const& [first, end] : beads.rigid)
        for (std::int64_t k = first + 1; k < end; ++k) joined.emplace_back(k - 1, k);
    for (std::size_t i = joined.size(); i-- > 0;)
        joined.emplace_back(joined[i].second, joined[i].first);
    std::sort(joined.begin(), joined.end());
    auto const from = [&](std::size_t i) {
        return positions[static_cast<std::size_t>(joined[i].second)] -
               positions[static_cast<std::size_t>(joined[i].first)];
    };
    for (std::size_t i = 0; i < joined.size(); ++i)
        for (std::size_t j = i + 1; j < joined.size() && joined[j].first == joined[i].first; ++j) {
            Vec3 const one = from(i), other = from(j);
            if (norm(cross(one, other)) <= straight_within * norm(one) * norm(other))
                return static_cast<std::size_t>(joined[i].first);
        }
    return std::nullopt;
}

[[noreturn]] void refuse_straight(Scene const& scene, BeadSystem const& beads, std::size_t middle) {
    throw InputError(fmt::format("forces at the start are not finite, perhaps because {} and its "
                                 "neighbours lie on a line, where torsions are undefined",
                                 name_of(beads, middle)),
                     scene.file,
                     "write `relax: true`, which bends the chain, or give other positions");
}

char const* const other_positions = "write `relax: true`, or give other positions";

std::string overlap_text(std::string const& pair, double distance) {
    return fmt::format("the start has overlapping beads, {} {:.3g} nm apart: ", pair, distance);
}

}  // namespace

bool StartForces::is_absurd() const {
    double const kt = Scene().boltzmann() * temperature;
    // `!(<=)` treats values that are not finite as absurd.
    if (!std::isfinite(energy) || !(largest_force <= ::catena::largest_force * kt)) return true;
    return !(energy <= most_energy * thermal) && largest_force > thermal_force * kt;
}

bool StartForces::is_undefined() const {
    double const kt = Scene().boltzmann() * temperature;
    return !std::isfinite(energy) && largest_force <= ::catena::largest_force * kt;
}

std::string StartForces::energy_text() const {
    std::string const found =
        std::isfinite(energy)
            ? fmt::format("{:.6g} kJ/mol ({:.3g} times the kinetic energy at {:.6g} K)", energy,
                          energy / thermal, temperature)
            : std::string(std::isnan(energy) ? "not a number" : "infinite");
    return fmt::format("{}, largest force {:.3g} kJ/mol/nm on {}", found, largest_force, force_at);
}

std::string StartForces::text() const {
    return nearest < 0 ? energy_text()
                       : energy_text() +
                             fmt::format(", nearest {}: {:.3g} nm apart", nearest_pair, nearest);
}

StartForces start_forces_of(Scene const& scene, BeadSystem const& beads,
                            std::vector<Vec3> const& positions, std::vector<Vec3> const& forces,
                            double energy) {
    StartForces found;
    found.energy = energy;
    found.temperature = scene.forces.openmm->temperature;
    found.thermal = 0.5 * static_cast<double>(degrees_of_freedom(scene)) * scene.boltzmann() *
                    found.temperature;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < forces.size(); ++i)
        if (double const force = norm(forces[i]); !(force <= found.largest_force)) {
            found.largest_force = force, worst = i;
            if (!std::isfinite(force)) break;
        }
    if (!forces.empty()) found.force_at = name_of(beads, worst);
    if (auto const near = worst_of(scene, beads, positions, forces))
        found.nearest = near->distance, found.nearest_pair = name_of(beads, *near);
    return found;
}

StartForces look_at_start(ChainSystem& system) {
    // The forces first: energies overwrite OpenMM's arrays of them.
    std::vector<Vec3> const forces = system.bead_forces();
    double energy = 0;
    for (EnergyTerm const& term : system.openmm()->energies()) energy += term.value;
    StartForces found;
    on_first_rank(system.communicator(), [&] {
        found = start_forces_of(system.scene(), system.beads(), bead_positions_of(system.scene()),
                                forces, energy);
        refuse_absurd(system.scene(), found);
    });
    return found;
}

void refuse_absurd(Scene const& scene, StartForces const& start, std::string const& relaxation) {
    if (!start.is_absurd()) return;
    bool const overlap = start.nearest >= 0 && start.nearest < touching;
    std::string what = relaxation.empty() ? "" : fmt::format("after relaxation ({}) ", relaxation);
    what += overlap ? overlap_text(start.nearest_pair, start.nearest)
                    : "the start positions are far from any thermal state: ";
    what += "potential energy " + (overlap ? start.energy_text() : start.text());
    throw InputError(what, scene.file,
                     start.is_undefined() ? "a force is beyond its range, such as a torn FENE "
                                            "bond: give other positions, in the right unit"
                     : relaxation.empty() ? other_positions
                                          : "give other positions");
}

void refuse_coinciding(Scene const& scene, Communicator const& communicator) {
    if (!scene.forces.openmm) return;
    on_first_rank(communicator, [&] {
        std::vector<Vec3> const positions = bead_positions_of(scene);
        BeadSystem const beads = bead_system_of(scene);
        bool const near = nearest_of(scene, beads, positions, coinciding).has_value();
        bool const torsions =
            !scene.forces.openmm->system.empty();  // a System may contain torsions
        std::optional<std::size_t> const straight =
            torsions ? middle_of_straight(beads, positions) : std::nullopt;
        if (!near && !straight) return;
        SingleRankForces forces(scene);
        SingleRankForces::EnergyAndForces const found = forces.at(positions);
        if (!near && !forces.are_finite()) refuse_straight(scene, beads, *straight);
        refuse_absurd(
            scene, start_forces_of(scene, forces.beads(), positions, found.forces, found.energy));
    });
}

}  // namespace catena
