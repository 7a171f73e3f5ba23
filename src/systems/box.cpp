// Implements the check of boxes against cutoffs.
#include "systems/box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "systems/subset.hpp"

namespace catena {
namespace {

/// Largest number of columns of cells of one cutoff width across the two longest edges. More are
/// allowed for as many particles. OpenMM's CPU platform takes about a hundred bytes and a
/// microsecond per column and evaluation.
constexpr double most_columns = 4e6;

/// Cutoff of a pair force, nm; 0 without a cutoff.
double cutoff_of(OpenMM::Force const& force) {
    if (auto const* pairs = dynamic_cast<OpenMM::NonbondedForce const*>(&force))
        return pairs->getNonbondedMethod() == OpenMM::NonbondedForce::NoCutoff
                   ? 0
                   : pairs->getCutoffDistance();
    double const reach = reach_of(force);
    return std::isfinite(reach) ? reach : 0;
}

/// Shortest cutoff of all forces, nm; infinite if there is none.
double shortest_cutoff(OpenMM::System const& system) {
    double shortest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < system.getNumForces(); ++i)
        if (double const cutoff = cutoff_of(system.getForce(i)); cutoff > 0)
            shortest = std::min(shortest, cutoff);
    return shortest;
}

}  // namespace

void refuse_box_beyond_cutoffs(OpenMM::System const& system, std::string const& where) {
    if (!system.usesPeriodicBoundaryConditions()) return;
    OpenMM::Vec3 a, b, c;
    system.getDefaultPeriodicBoxVectors(a, b, c);
    std::array<double, 3> edges{a[0], b[1], c[2]};
    std::sort(edges.begin(), edges.end());
    double const cutoff = shortest_cutoff(system),
                 columns = edges[1] / cutoff * (edges[2] / cutoff);
    if (columns <= std::max(most_columns, static_cast<double>(system.getNumParticles()))) return;
    throw InputError(
        fmt::format("the box's edges {:.6g} and {:.6g} nm are too long for OpenMM's neighbour "
                    "lists with a cutoff of {:.4g} nm",
                    edges[2], edges[1], cutoff),
        where,
        fmt::format("give a box whose two longest edges multiply to {:.3g} nm^2 or less",
                    most_columns * cutoff * cutoff));
}

}  // namespace catena
