// Implements extended and self-avoiding conformations and the lengths of links.
#include "generate/conformation.hpp"

#include <cmath>
#include <limits>

#include "generate/cell_stack.hpp"
#include "generate/random.hpp"

namespace catena::scene {

namespace {

/// Inboard end of link k (from 0): the bead on which bead k hangs, or the anchor.
Vec3 inboard_end(BeadArrays const& beads, Parents parents, std::size_t k) {
    return k == 0 ? beads.anchor : beads.position[inboard_of(parents, k)];
}

}  // namespace

std::vector<Vec3> extended_conformation(std::int64_t points, double length) {
    std::vector<Vec3> at(static_cast<std::size_t>(points));
    double const along = std::sqrt(0.75) * length, across = 0.5 * length;
    for (std::int64_t k = 0; k < points; ++k)
        at[static_cast<std::size_t>(k)] = {
            {static_cast<double>(k) * along, k % 2 == 0 ? 0.0 : across, 0}};
    return at;
}

std::vector<Vec3> self_avoiding_conformation(std::int64_t points, double length, double excluded,
                                             std::uint64_t seed) {
    CellStack grown(excluded);
    grown.push(Vec3::zero());
    std::int64_t furthest = 1, retreat = 1;
    std::uint64_t attempt = 0;
    while (grown.size() < points) {
        bool found = false;
        for (int trial = 0; trial < 64 && !found; ++trial) {
            Vec3 const candidate =
                plus_scaled(grown.top(), length, Draws(seed, grown.size(), attempt++).on_sphere());
            if (found = !grown.crowded(candidate); found) grown.push(candidate);
        }
        if (grown.size() > furthest) {
            furthest = grown.size();
            retreat = 1;
        }
        // The retreat doubles with each failure, so that the walk leaves any dead end.
        if (!found) {
            for (std::int64_t i = 0; i < retreat && grown.size() > 1; ++i) grown.pop();
            retreat *= 2;
        }
    }
    return grown.take();
}

void take_lengths(BeadArrays& beads, Base base, Parents parents) {
    beads.length.assign(beads.size(), 0.0);
    for (std::size_t k = base == Base::fixed ? 0 : 1; k < beads.size(); ++k)
        beads.length[k] = norm(beads.position[k] - inboard_end(beads, parents, k));
}

std::int64_t coincident_bead(BeadArrays const& beads, Base base, Parents parents) {
    for (std::size_t k = base == Base::fixed ? 0 : 1; k < beads.size(); ++k) {
        Vec3 const from = inboard_end(beads, parents, k);
        // Positions are rounded to half a unit in their last place. A link shorter than a few of
        // these units has no direction.
        double const rounding =
            16 * std::numeric_limits<double>::epsilon() * (norm(from) + norm(beads.position[k]));
        if (!(norm(beads.position[k] - from) > rounding)) return static_cast<std::int64_t>(k);
    }
    return -1;
}

}  // namespace catena::scene
