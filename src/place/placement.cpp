// Implements the placement of chains by their bounding spheres. All movable chains share one grid,
// whose cells are as wide as the largest of them. If a box has too few clear cells, chains that may
// be regrown are packed instead.
#include "place/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "generate/outline.hpp"
#include "generate/place_grid.hpp"
#include "place/chain_motion.hpp"
#include "place/packing.hpp"

namespace catena::scene {

namespace {

/// Largest coordinate: a double resolves 1e-7 there.
double constexpr farthest = 1e9;

/// Sphere around the centre of the chain's bounding box, with the gap of two links.
Sphere sphere_around(ChainSpec const& chain) {
    Outline const outline = outline_of(chain);
    Vec3 low = outline.points[0], high = low;
    for (Vec3 const& p : outline.points)
        for (int i = 0; i < 3; ++i)
            low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    // The centre of the bounding box is close to that of the smallest sphere.
    Sphere sphere{0.5 * (low + high), 0, 2 * outline.link};
    for (Vec3 const& p : outline.points)
        sphere.radius = std::max(sphere.radius, norm(p - sphere.centre));
    return sphere;
}

/// True if the draft may be regrown.
bool is_regrown(Draft const* draft) { return draft->regrown == Regrowth::yes; }

/// Throws InputError for a chain that extends beyond `farthest`.
void refuse_far(Draft const& draft, Sphere const& sphere) {
    double reach = 0;
    for (double const x : sphere.centre.data) reach = std::max(reach, std::abs(x) + sphere.radius);
    if (reach <= farthest && sphere.gap <= 4 * farthest) return;
    fail(*draft.node,
         fmt::format("chain `{}` reaches {:.3g} from the origin, beyond the range of positions",
                     shown(draft.chain.name), reach),
         fmt::format("correct its coordinates: the largest is {:g}", farthest));
}

/// Bounding sphere of a draft; throws InputError beyond the largest coordinate.
Sphere sphere_of(Draft const& draft) {
    Sphere const sphere = sphere_around(draft.chain);
    refuse_far(draft, sphere);
    return sphere;
}

/// A box, or a region that is filled like a box.
struct Room {
    /// Edges of the box; none for unlimited space.
    std::optional<Vec3> const& edges;
    /// Name in messages.
    char const* name;
};

/// Throws InputError for a room that has too few places.
[[noreturn]] void refuse(Draft const& draft, Room const& in, std::size_t room, double width,
                         std::size_t wanted) {
    Vec3 const& edges = *in.edges;
    bool const residues = draft.regrown == Regrowth::if_asked;
    fail(*draft.node,
         fmt::format("{} {:.6g} x {:.6g} x {:.6g} has room for {} {} side by side, each within a "
                     "sphere {:.4g} wide, not for {}",
                     in.name, edges[0], edges[1], edges[2], room, room == 1 ? "chain" : "chains",
                     width, wanted),
         std::string("enlarge ") + in.name +
             (residues
                  ? ", lower `count` or write `conformation: self_avoiding` (without "
                    "`positions`), which is packed more densely"
                  : " or lower `count`; only free, unbranched chains of a `sequence` or `fasta` "
                    "without `positions` are packed more densely"));
}

/// Places the chains `moving` next to each other, clear of `placed`. Returns false and moves
/// nothing if the room is too small for chains that can be regrown instead.
bool place_side_by_side(std::vector<Draft*> const& moving, std::vector<Sphere> const& placed,
                        Room const& box) {
    std::vector<Sphere> spheres;
    double width = 0;
    for (Draft const* const draft : moving) {
        spheres.push_back(sphere_of(*draft));
        width = std::max(width, 2 * spheres.back().radius + spheres.back().gap);
    }
    if (width == 0) width = 1;  // single beads: any distance is enough
    std::vector<Vec3> const cells = PlaceGrid(placed, width, box.edges).find(moving.size());
    if (cells.size() < moving.size()) {
        if (std::any_of(moving.begin(), moving.end(), is_regrown)) return false;
        refuse(*moving.front(), box, cells.size(), width, moving.size());
    }
    for (std::size_t i = 0; i < moving.size(); ++i) {
        refuse_far(*moving[i], {cells[i], spheres[i].radius, 0});
        translate(moving[i]->chain, cells[i] - spheres[i].centre);
    }
    return true;
}

}  // namespace

void give_places(std::vector<Draft>& drafts, std::optional<Vec3> const& box, std::uint64_t seed,
                 char const* name) {
    Room const room{box, name};
    std::vector<Draft*> moving;
    std::vector<Sphere> placed;
    for (Draft& draft : drafts) {
        if (draft.movable)
            moving.push_back(&draft);
        else
            placed.push_back(sphere_of(draft));
    }
    if (moving.empty() || place_side_by_side(moving, placed, room)) return;
    // Chains that keep their shape are placed first, then the others grow around them.
    moving.erase(std::remove_if(moving.begin(), moving.end(), is_regrown), moving.end());
    if (!moving.empty()) place_side_by_side(moving, placed, room);
    pack(drafts, *box, seed, name);
}

}  // namespace catena::scene
