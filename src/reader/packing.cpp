// Implements the packing of chains. Impossible boxes are refused first, by the volume of the beads
// and by the narrowest edge. The chains then grow at the same pace, and the remaining overlaps are
// relaxed.
#include "reader/packing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generate/crowd.hpp"
#include "generate/outline.hpp"
#include "generate/random.hpp"
#include "reader/sequences.hpp"

namespace catena::scene {

namespace {

/// Largest volume fraction: random close packing of spheres.
double constexpr densest = 0.64;
/// Smallest edge of the box in excluded distances. In a narrower box a bead interacts with two
/// images of another bead.
double constexpr narrowest = 2.5;
/// Largest number of relaxation steps.
std::int64_t constexpr most_steps = 2000;
/// Largest number of points; indices of points and cells have 32 bits.
std::size_t constexpr most_points = std::size_t{1} << 28;

/// Edges of a box for messages.
std::string text_of(Vec3 const& box) {
    return fmt::format("{:.6g} x {:.6g} x {:.6g}", box[0], box[1], box[2]);
}

/// Volume of spheres with the excluded distance as diameter. Link neighbours overlap in a lens;
/// half of it is subtracted for each of the two.
double volume_of(Crowd const& crowd) {
    double const d = crowd.excluded;
    double volume = 0;
    for (std::size_t i = 0; i < crowd.movable(); ++i) {
        volume += Draws::pi / 6 * d * d * d;
        if (double const l = crowd.length[i]; l > 0)
            volume -= Draws::pi / 12 * (2 * d + l) * (d - l) * (d - l);
    }
    return volume;
}

/// Throws InputError for too many beads, too narrow a box or too high a volume fraction.
void refuse_impossible(Crowd const& crowd, Node const& node, char const* name) {
    Vec3 const& box = crowd.box;
    if (crowd.at.size() > most_points)
        fail(node, fmt::format("{} beads to pack", crowd.at.size()),
             fmt::format("pack {} or fewer", most_points));
    double const edge = std::min({box[0], box[1], box[2]});
    if (edge < narrowest * crowd.excluded * (1 - 1e-9))
        fail(node,
             fmt::format("{} {} is too narrow to pack chains whose beads stay {:.4g} nm apart",
                         name, text_of(box), crowd.excluded),
             fmt::format("give edges of {:.4g} nm or more", narrowest * crowd.excluded));
    double const filled = volume_of(crowd) / (box[0] * box[1] * box[2]);
    if (filled > densest)
        fail(node,
             fmt::format("{} beads that stay {:.4g} nm apart would fill {:.3g} of {} {}, random "
                         "packings of spheres fill {:.2g}",
                         crowd.movable(), crowd.excluded, filled, name, text_of(box), densest),
             fmt::format("make each edge {:.3g} times as long or longer, or lower `count`",
                         std::cbrt(filled / densest) + 5e-4));
}

/// Collects the chains to grow, then the points of all other chains as fixed points.
Crowd crowd_of(std::vector<Draft> const& drafts, Vec3 const& box) {
    Crowd crowd;
    crowd.box = box;
    crowd.excluded = excluded_distance;
    crowd.first.push_back(0);
    for (Draft const& draft : drafts) {
        if (draft.regrown != Regrowth::yes) continue;
        BeadArrays const& beads = draft.chain.beads;
        crowd.at.insert(crowd.at.end(), beads.position.begin(), beads.position.end());
        crowd.length.insert(crowd.length.end(), beads.length.begin(), beads.length.end());
        // The first bead of a chain has no link to the preceding point.
        crowd.length[crowd.first.back()] = 0;
        crowd.first.push_back(crowd.at.size());
    }
    for (Draft const& draft : drafts) {
        if (draft.regrown == Regrowth::yes) continue;
        std::vector<Vec3> const points = outline_of(draft.chain).points;
        crowd.at.insert(crowd.at.end(), points.begin(), points.end());
    }
    crowd.length.resize(crowd.at.size(), 0.0);
    return crowd;
}

}  // namespace

void pack(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed, char const* name) {
    Crowd crowd = crowd_of(drafts, box);
    auto const first = std::find_if(drafts.begin(), drafts.end(),
                                    [](Draft const& d) { return d.regrown == Regrowth::yes; });
    refuse_impossible(crowd, *first->node, name);
    /// Stream of the packing, distinct from the streams of single chains.
    std::uint64_t constexpr packing = std::uint64_t{1} << 63;
    grow(crowd, seed_of_stream(seed, packing));
    Relaxed const relaxed = relax(crowd, most_steps);
    if (relaxed.overlaps > 0)
        fail(*first->node,
             fmt::format("packing {} chains into {} {} left {} pairs of beads closer than {:.4g} "
                         "nm, the closest at {:.3g} nm, after {} steps",
                         crowd.chains(), name, text_of(box), relaxed.overlaps, crowd.excluded,
                         relaxed.nearest, relaxed.steps),
             fmt::format("enlarge {} or lower `count`", name));
    // Positions return in the order in which crowd_of() collected them.
    std::size_t next = 0;
    for (Draft& draft : drafts)
        if (draft.regrown == Regrowth::yes)
            for (Vec3& position : draft.chain.beads.position) position = crowd.at[next++];
}

}  // namespace catena::scene
