#include "scene/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/outline.hpp"
#include "scene/packing.hpp"

namespace catena::scene {

namespace {

struct Sphere {
    Vec3 centre = Vec3::zero();
    double radius = 0;
    double gap = 0;  // two links
};

Sphere sphere_around(ChainSpec const& chain) {
    Outline const outline = outline_of(chain);
    Vec3 low = outline.points[0], high = low;
    for (Vec3 const& p : outline.points)
        for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    Sphere sphere{0.5 * (low + high), 0, 2 * outline.link};
    for (Vec3 const& p : outline.points) sphere.radius = std::max(sphere.radius, norm(p - sphere.centre));
    return sphere;
}

void move(ChainSpec& chain, Vec3 const& by) {
    if (chain.tip_joint.anchor) chain.tip_joint.anchor = *chain.tip_joint.anchor + by;
    for (Vec3& position : chain.beads.position) position = position + by;
    for (Vec3& position : chain.linked.position) position = position + by;
    bool const fixed = chain.base == Base::fixed;
    if (chain.is_beads()) {
        if (fixed) chain.beads.anchor = chain.beads.anchor + by;
    } else if (chain.is_linked()) {
        if (fixed) chain.linked.anchor = chain.linked.anchor + by;
    } else {
        Vec3& place = fixed ? chain.bodies.translation[0] : chain.bodies.free_position;
        place = place + by;
    }
}

bool is_regrown(Draft const* draft) { return draft->regrown == Regrown::yes; }

class Grid {
  public:
    Grid(std::vector<Sphere> const& placed, double width, std::optional<Vec3> const& box) : placed_(placed), width_(width), box_(box) {}

    /// Middles of the cells of an n0 x n1 x n2 grid which are clear of the placed chains, at most `wanted` of them.
    std::vector<Vec3> clear_cells(std::array<std::int64_t, 3> const& n, std::size_t wanted) const {
        std::vector<Vec3> cells;
        for (std::int64_t z = 0; z < n[2]; ++z)
            for (std::int64_t y = 0; y < n[1]; ++y)
                for (std::int64_t x = 0; x < n[0] && cells.size() < wanted; ++x)
                    if (Vec3 const cell = middle({x, y, z}, n); is_clear(cell)) cells.push_back(cell);
        return cells;
    }

  private:
    Vec3 middle(std::array<std::int64_t, 3> const& at, std::array<std::int64_t, 3> const& n) const {
        Vec3 cell;
        for (std::size_t i = 0; i < 3; ++i) {
            double const index = static_cast<double>(at[i]), count = static_cast<double>(n[i]);
            int const axis = static_cast<int>(i);
            cell[axis] = box_ ? (index + 0.5) * (*box_)[axis] / count : (index - 0.5 * (count - 1)) * width_;
        }
        return cell;
    }
    bool is_clear(Vec3 const& cell) const {
        return std::none_of(placed_.begin(), placed_.end(), [&](Sphere const& other) {
            Vec3 apart = cell - other.centre;
            for (int i = 0; i < 3 && box_; ++i) apart[i] -= (*box_)[i] * std::round(apart[i] / (*box_)[i]);
            return norm(apart) < 0.5 * width_ + other.radius + 0.5 * other.gap;
        });
    }

    std::vector<Sphere> const& placed_;
    double width_;
    std::optional<Vec3> const& box_;
};

/// Middles of clear cells: `wanted` of them or, where the box has no room, all that were found.
std::vector<Vec3> find_cells(Grid const& grid, std::size_t wanted, double width, std::optional<Vec3> const& box) {
    std::array<std::int64_t, 3> most{INT64_MAX, INT64_MAX, INT64_MAX};
    for (int i = 0; i < 3 && box; ++i) most[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor((*box)[i] / width));
    std::int64_t const largest = *std::max_element(most.begin(), most.end());
    std::vector<Vec3> cells;
    // The coarsest grid that has room, so that few chains spread over the box and a lone one lies in its middle.
    for (auto n = static_cast<std::int64_t>(std::ceil(std::cbrt(static_cast<double>(wanted)) - 1e-9)); cells.size() < wanted; ++n) {
        cells = grid.clear_cells({std::min(n, most[0]), std::min(n, most[1]), std::min(n, most[2])}, wanted);
        if (n >= largest) break;
    }
    return cells;
}

[[noreturn]] void refuse(Draft const& draft, Vec3 const& box, std::size_t room, double width, std::size_t wanted) {
    bool const residues = draft.regrown == Regrown::if_asked;
    fail(*draft.node,
         fmt::format("the box {:.6g} x {:.6g} x {:.6g} has room for {} chains side by side, each within a sphere {:.4g} wide, not for {}",
                     box[0], box[1], box[2], room, width, wanted),
         residues
             ? "enlarge the box, lower `count` or write `conformation: self_avoiding` (without `positions`), which is packed more densely"
             : "enlarge the box or lower `count`; only free chains of residues without `positions` are packed more densely");
}

/// Puts the chains `moving` side by side, clear of `placed`; false and nothing moved where the box has no room for chains that can be grown
/// into it instead.
bool place_side_by_side(std::vector<Draft*> const& moving, std::vector<Sphere> const& placed, std::optional<Vec3> const& box) {
    std::vector<Sphere> spheres;
    double width = 0;
    for (Draft const* const draft : moving) {
        spheres.push_back(sphere_around(draft->chain));
        width = std::max(width, 2 * spheres.back().radius + spheres.back().gap);
    }
    if (width == 0) width = 1;  // lone beads: any distance will do
    Grid const grid(placed, width, box);
    std::vector<Vec3> const cells = find_cells(grid, moving.size(), width, box);
    if (cells.size() < moving.size()) {
        if (std::any_of(moving.begin(), moving.end(), is_regrown)) return false;
        refuse(*moving.front(), *box, cells.size(), width, moving.size());
    }
    for (std::size_t i = 0; i < moving.size(); ++i) move(moving[i]->chain, cells[i] - spheres[i].centre);
    return true;
}

}  // namespace

void give_places(std::vector<Draft>& drafts, std::optional<Vec3> const& box, std::uint64_t seed) {
    std::vector<Draft*> moving;
    std::vector<Sphere> placed;
    for (Draft& draft : drafts) {
        if (draft.movable)
            moving.push_back(&draft);
        else
            placed.push_back(sphere_around(draft.chain));
    }
    if (moving.empty() || place_side_by_side(moving, placed, box)) return;
    // Chains that keep their shape take their places first, the others grow around them.
    moving.erase(std::remove_if(moving.begin(), moving.end(), is_regrown), moving.end());
    if (!moving.empty()) place_side_by_side(moving, placed, box);
    pack(drafts, *box, seed);
}

}  // namespace catena::scene
