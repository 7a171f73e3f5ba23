// Implements the packing of chains. Impossible boxes are refused first, by the volume of the beads
// and by the narrowest edge. The chains then grow at the same pace, and the remaining overlaps are
// relaxed.
#include "place/packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "generate/conformation.hpp"
#include "generate/crowd.hpp"
#include "generate/outline.hpp"
#include "generate/random.hpp"
#include "scene/branches.hpp"

namespace catena::scene {

namespace {

/// Largest volume fraction: random close packing of spheres.
double constexpr densest = 0.64;
/// Volume fraction that packings reach without exception, for advice.
double constexpr comfortable = 0.42;
/// Least factor by which an advice enlarges a region.
double constexpr more = 1.1;
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

/// Volume of spheres with the excluded distance as diameter, for the beads of some chains. Link
/// neighbours that are nearer overlap in a lens; half of it is subtracted for each of the two.
double volume_of(Crowd const& crowd, std::size_t first_chain, std::size_t end_chain) {
    double const d = crowd.excluded;
    double volume = 0;
    for (std::size_t i = crowd.first[first_chain]; i < crowd.first[end_chain]; ++i) {
        volume += Draws::pi / 6 * d * d * d;
        if (double const l = crowd.length[i]; l > 0 && l < d)
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
    double const filled = volume_of(crowd, 0, crowd.chains()) / (box[0] * box[1] * box[2]);
    if (filled > densest)
        fail(node,
             fmt::format("{} beads that stay {:.4g} nm apart would fill {:.3g} of {} {}, random "
                         "packings of spheres fill {:.2g}",
                         crowd.movable(), crowd.excluded, filled, name, text_of(box), densest),
             fmt::format("make each edge {:.3g} times as long or longer, or lower `count`",
                         std::cbrt(filled / densest) + 5e-4));
}

/// Walls of a region, for the centres of beads.
Walls walls_of(std::optional<Region> const& region) {
    Walls walls;
    for (std::size_t axis = 0; region && axis < 3; ++axis)
        if (region->walled[axis])
            walls[axis] = {region->low[static_cast<int>(axis)],
                           region->high[static_cast<int>(axis)]};
    return walls;
}

/// Chains that grow in the same region, and the volume of their beads.
struct Share {
    Draft const* first = nullptr;
    std::size_t chains = 0, beads = 0;
    double volume = 0;
};

/// Returns the shares of the regions with walls, in the order of the drafts.
std::vector<Share> shares_of(std::vector<Draft> const& drafts, Crowd const& crowd) {
    std::vector<Share> shares;
    std::size_t chain = 0;
    for (Draft const& draft : drafts) {
        if (draft.regrown != Regrowth::yes) continue;
        std::size_t const at = chain++;
        if (!draft.region || !draft.region->has_walls()) continue;
        auto share = std::find_if(shares.begin(), shares.end(), [&](Share const& known) {
            return known.first->region->node == draft.region->node;
        });
        if (share == shares.end()) share = shares.insert(shares.end(), Share{&draft});
        ++share->chains, share->beads += crowd.first[at + 1] - crowd.first[at];
        share->volume += volume_of(crowd, at, at + 1);
    }
    return shares;
}

/// Advice for a region that is too small for the chains of a share.
std::string advice(Share const& share, Crowd const& crowd) {
    Region const& region = *share.first->region;
    double const wanted = share.volume / comfortable;
    if (region.slab >= 0) {
        double const across = region.volume_of_spheres(0) / region.extent()[region.slab];
        // A packing that failed below this density needs more room all the same.
        double const least = more * region.extent()[region.slab];
        return advice_on_thickness(region, crowd.box,
                                   std::max(least, wanted / across - crowd.excluded));
    }
    double const larger = std::max(more, wanted / region.volume_of_spheres(crowd.excluded));
    return fmt::format("make its volume {:.2g} times as large, or lower the number of chains",
                       larger + 0.05);
}

/// Throws InputError for regions with walls that are too thin or too full.
void refuse_full_regions(std::vector<Share> const& shares, Crowd const& crowd) {
    for (Share const& share : shares) {
        Region const& region = *share.first->region;
        Vec3 const extent = region.extent();
        double const thin = std::min({extent[0], extent[1], extent[2]});
        if (thin < crowd.excluded)
            fail(*region.node,
                 fmt::format("{} is {:.4g} nm thick, thinner than a bead of {:.4g} nm",
                             region.name(), thin, crowd.excluded),
                 fmt::format("give it {:.4g} nm or more", crowd.excluded));
        double const filled = share.volume / region.volume_of_spheres(crowd.excluded);
        if (filled > densest)
            fail(*region.node,
                 fmt::format(
                     "{} chains of {} beads in all would fill {:.3g} of {}, random packings "
                     "of spheres {:.4g} nm wide fill {:.2g}",
                     share.chains, share.beads, filled, region.name(), crowd.excluded, densest),
                 advice(share, crowd));
    }
}

/// Throws the InputError for what the relaxation left.
[[noreturn]] void refuse_packing(std::vector<Share> const& shares, Draft const& first,
                                 Crowd const& crowd, Relaxed const& relaxed, char const* name) {
    std::string const left = fmt::format(
        " left {} pairs of beads closer than {:.4g} nm, the closest at {:.3g} nm, after "
        "{} steps",
        relaxed.overlaps, crowd.excluded, relaxed.nearest, relaxed.steps);
    auto const fullest =
        std::max_element(shares.begin(), shares.end(), [&](Share const& a, Share const& b) {
            double const d = crowd.excluded;
            return a.volume / a.first->region->volume_of_spheres(d) <
                   b.volume / b.first->region->volume_of_spheres(d);
        });
    if (fullest != shares.end())
        fail(*fullest->first->region->node,
             fmt::format(
                 "packing {} chains into {}{}{}", fullest->chains, fullest->first->region->name(),
                 left,
                 relaxed.outside > 0 ? fmt::format(", and {} beads outside", relaxed.outside) : ""),
             advice(*fullest, crowd));
    fail(*first.node,
         fmt::format("packing {} chains into {} {}{}", crowd.chains(), name, text_of(crowd.box),
                     left),
         fmt::format("enlarge {} or lower `count`", name));
}

/// Sets Crowd::parent if one of the chains to grow branches.
void hang_branches(std::vector<Draft> const& drafts, Crowd& crowd) {
    auto const grows_branches = [](Draft const& draft) {
        return draft.regrown == Regrowth::yes && draft.chain.is_branched();
    };
    if (std::none_of(drafts.begin(), drafts.end(), grows_branches)) return;
    crowd.parent.assign(crowd.at.size(), -1);
    std::size_t first = 0;
    for (Draft const& draft : drafts) {
        if (draft.regrown != Regrowth::yes) continue;
        for (std::size_t k = 1; k < draft.chain.size(); ++k)
            crowd.parent[first + k] =
                static_cast<std::int64_t>(first + inboard_of(draft.chain.parent, k));
        first += draft.chain.size();
    }
}

/// Collects the chains to grow, then the points of all other chains as fixed points.
Crowd crowd_of(std::vector<Draft> const& drafts, Vec3 const& box) {
    Crowd crowd;
    crowd.box = box;
    crowd.first.push_back(0);
    bool const is_walled = std::any_of(drafts.begin(), drafts.end(), [](Draft const& draft) {
        return draft.region && draft.region->has_walls();
    });
    for (Draft const& draft : drafts) {
        if (draft.regrown != Regrowth::yes) continue;
        crowd.excluded = std::max(crowd.excluded, draft.excluded);
        BeadArrays const& beads = draft.chain.beads;
        crowd.at.insert(crowd.at.end(), beads.position.begin(), beads.position.end());
        crowd.length.insert(crowd.length.end(), beads.length.begin(), beads.length.end());
        // The first bead of a chain has no link to the preceding point.
        crowd.length[crowd.first.back()] = 0;
        crowd.first.push_back(crowd.at.size());
        if (is_walled) crowd.walls.push_back(walls_of(draft.region));
    }
    for (Draft const& draft : drafts) {
        if (draft.regrown == Regrowth::yes) continue;
        std::vector<Vec3> const points = outline_of(draft.chain).points;
        crowd.at.insert(crowd.at.end(), points.begin(), points.end());
    }
    crowd.length.resize(crowd.at.size(), 0.0);
    hang_branches(drafts, crowd);
    return crowd;
}

}  // namespace

void pack(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed, char const* name) {
    Crowd crowd = crowd_of(drafts, box);
    auto const first = std::find_if(drafts.begin(), drafts.end(),
                                    [](Draft const& d) { return d.regrown == Regrowth::yes; });
    std::vector<Share> const shares = shares_of(drafts, crowd);
    refuse_full_regions(shares, crowd);
    refuse_impossible(crowd, *first->node, name);
    /// Stream of the packing, distinct from the streams of single chains.
    std::uint64_t constexpr packing = std::uint64_t{1} << 63;
    grow(crowd, seed_of_stream(seed, packing));
    Relaxed const relaxed = relax(crowd, most_steps);
    if (relaxed.overlaps > 0 || relaxed.outside > 0)
        refuse_packing(shares, *first, crowd, relaxed, name);
    // Positions return in the order in which crowd_of() collected them.
    std::size_t next = 0;
    for (Draft& draft : drafts)
        if (draft.regrown == Regrowth::yes)
            for (Vec3& position : draft.chain.beads.position) position = crowd.at[next++];
}

}  // namespace catena::scene
