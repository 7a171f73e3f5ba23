// Implements the placement of chains by their bounding spheres. All movable chains share one grid,
// whose cells are as wide as the largest of them. If a box has too few clear cells, chains that may
// be regrown are packed instead, and the others inserted at random places.
#include "place/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "generate/outline.hpp"
#include "generate/place_grid.hpp"
#include "place/chain_motion.hpp"
#include "place/insertion.hpp"
#include "place/packing.hpp"

namespace catena::scene {

namespace {

/// Largest coordinate: a double resolves 1e-7 there.
double constexpr farthest = 1e9;
/// Largest number of bodies of a chain for which random places are tried.
std::size_t constexpr longest_inserted = 20'000;

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
    /// Smallest distance of chains at random places.
    double least;
    /// Name in messages.
    char const* name;
};

/// Places on the lattice of a room.
struct Lattice {
    std::size_t places;
    double width;  // of a cell
};

/// Throws InputError for a room that has too few places. `inserted` is the number of chains that
/// found a random place; none if that was not tried.
[[noreturn]] void refuse(std::vector<Draft*> const& moving, Room const& in, Lattice const& lattice,
                         std::optional<std::size_t> inserted) {
    Draft const& draft = *moving.front();
    Vec3 const& edges = *in.edges;
    bool const residues = draft.regrown == Regrowth::if_asked;
    std::string const what = fmt::format(
        "{} {:.6g} x {:.6g} x {:.6g} has room for {} {} side by side, each within a sphere {:.4g} "
        "wide, not for {}{}",
        in.name, edges[0], edges[1], edges[2], lattice.places,
        lattice.places == 1 ? "chain" : "chains", lattice.width, moving.size(),
        inserted ? fmt::format("; at random places {} found room", *inserted) : "");
    fail(*draft.node, what,
         std::string("enlarge ") + in.name +
             (residues ? ", lower `count` or write `conformation: self_avoiding` (without "
                         "`positions`), which is packed more densely"
                       : " or lower `count`; only free chains of a `sequence` or "
                         "`fasta` without `positions` and cross-links are packed more densely"));
}

/// Width of the cells for single beads, which have no size: 1 nm, or what gives each a cell of a
/// room in SI units.
double width_for_points(std::size_t moving, std::size_t placed, Room const& room) {
    if (room.least > 0 || !room.edges) return 1;
    Vec3 const& edges = *room.edges;
    std::size_t constexpr around = 27;  // cells that a point with a place may take
    auto const cells = static_cast<double>(moving + around * placed);
    double constexpr rounding = 1 - 1e-9;  // must not cost a layer
    return rounding * std::min({edges[0], edges[1], edges[2]}) / std::ceil(std::cbrt(cells));
}

/// Places the chains `moving` next to each other, clear of `placed`. Moves nothing if the room has
/// fewer places than chains.
Lattice place_side_by_side(std::vector<Draft*> const& moving, std::vector<Sphere> const& placed,
                           Room const& box) {
    std::vector<Sphere> spheres;
    double width = 0;
    for (Draft const* const draft : moving) {
        spheres.push_back(sphere_of(*draft));
        width = std::max(width, 2 * spheres.back().radius + spheres.back().gap);
    }
    if (width == 0) width = width_for_points(moving.size(), placed.size(), box);
    std::vector<Vec3> const cells = PlaceGrid(placed, width, box.edges).find(moving.size());
    for (std::size_t i = 0; i < moving.size() && cells.size() >= moving.size(); ++i) {
        refuse_far(*moving[i], {cells[i], spheres[i].radius, 0});
        translate(moving[i]->chain, cells[i] - spheres[i].centre);
    }
    return {cells.size(), width};
}

/// True if random places may serve where the lattice has too few: for beads and bodies on links,
/// unless all may be regrown if the scene asks for it. Trials of longer chains take minutes.
bool may_insert(std::vector<Draft*> const& moving) {
    return std::all_of(moving.begin(), moving.end(),
                       [](Draft const* d) {
                           bool const links = d->chain.is_beads() || d->chain.is_linked();
                           return links && d->chain.size() <= longest_inserted;
                       }) &&
           !std::all_of(moving.begin(), moving.end(),
                        [](Draft const* d) { return d->regrown == Regrowth::if_asked; });
}

/// Places the chains `moving`, which keep their shape, side by side or else at random. Returns a
/// sentence on random places, or an empty one. Throws InputError if they do not fit.
std::string place_shapes(std::vector<Draft>& drafts, std::vector<Draft*> const& moving,
                         std::vector<Sphere> const& placed, Room const& room, std::uint64_t seed) {
    Lattice const lattice = place_side_by_side(moving, placed, room);
    if (lattice.places >= moving.size()) return {};
    if (!may_insert(moving)) refuse(moving, room, lattice, std::nullopt);
    std::size_t const inserted = insert_if_all_fit(drafts, *room.edges, seed, room.least);
    if (inserted < moving.size()) refuse(moving, room, lattice, inserted);
    return fmt::format(
        "{} chains that keep their shape do not fit side by side into {}: they start at random "
        "places in it, and turned at random unless something holds them",
        moving.size(), room.name);
}

}  // namespace

std::string give_places(std::vector<Draft>& drafts, std::optional<Vec3> const& box,
                        std::uint64_t seed, double least, char const* name) {
    Room const room{box, least, name};
    std::vector<Draft*> moving;
    std::vector<Sphere> placed;
    for (Draft& draft : drafts) {
        if (draft.movable)
            moving.push_back(&draft);
        else
            placed.push_back(sphere_of(draft));
    }
    if (moving.empty()) return {};
    if (std::none_of(moving.begin(), moving.end(), is_regrown))
        return place_shapes(drafts, moving, placed, room, seed);
    if (place_side_by_side(moving, placed, room).places >= moving.size()) return {};
    // Chains that keep their shape are placed first, then the others grow around them.
    moving.erase(std::remove_if(moving.begin(), moving.end(), is_regrown), moving.end());
    std::string note;
    if (!moving.empty()) note = place_shapes(drafts, moving, placed, room, seed);
    pack(drafts, *box, seed, name);
    return note;
}

}  // namespace catena::scene
