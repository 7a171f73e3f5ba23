#include "scene/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/pose.hpp"

namespace catena::scene {

namespace {

struct Sphere {
    Vec3 centre = Vec3::zero();
    double radius = 0;
    double gap = 0;  // two links
};

/// Origins, centres of mass and the longest stretch between two of them along the chain.
struct Outline {
    std::vector<Vec3> points;
    double link = 0;
};

void add_carried(Outline& outline, CarriedBeads const& carried, std::size_t k, Pose const& pose) {
    if (carried.offset.empty()) return;
    for (auto b = static_cast<std::size_t>(carried.offset[k]); b < static_cast<std::size_t>(carried.offset[k + 1]); ++b)
        outline.points.push_back(pose.origin + to_matrix(pose.orientation) * carried.position[b]);
}

Outline outline_of(BeadArrays const& beads) {
    Outline outline{beads.position, 0};
    for (double const length : beads.length) outline.link = std::max(outline.link, length);
    return outline;
}

Outline outline_of(BodyArrays const& bodies) {
    Outline outline;
    Pose pose;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        Pose const next = next_pose(bodies, k, pose);
        if (k > 0) outline.link = std::max(outline.link, norm(next.origin - pose.origin));
        pose = next;
        outline.points.push_back(pose.origin);
        outline.points.push_back(pose.origin + to_matrix(pose.orientation) * bodies.com[k]);
        outline.link = std::max(outline.link, norm(bodies.com[k]));
        add_carried(outline, bodies.carried, k, pose);
    }
    return outline;
}

Outline outline_of(LinkedArrays const& linked) {
    Outline outline;
    for (std::size_t k = 0; k < linked.size(); ++k) {
        auto const& q = linked.orientation[k];
        Pose const pose{{q[0], q[1], q[2], q[3]}, linked.position[k]};
        for (Vec3 const& end : {Vec3::zero(), linked.inboard[k], linked.outboard[k]})
            outline.points.push_back(pose.origin + to_matrix(pose.orientation) * end);
        outline.link = std::max({outline.link, linked.length[k], norm(linked.inboard[k]), norm(linked.outboard[k])});
        add_carried(outline, linked.carried, k, pose);
    }
    return outline;
}

Sphere sphere_around(ChainSpec const& chain) {
    Outline const outline = chain.is_beads()    ? outline_of(chain.beads)
                            : chain.is_linked() ? outline_of(chain.linked)
                                                : outline_of(chain.bodies);
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

std::vector<Vec3> find_cells(Grid const& grid, std::size_t wanted, double width, std::optional<Vec3> const& box, Node const& node) {
    std::array<std::int64_t, 3> most{INT64_MAX, INT64_MAX, INT64_MAX};
    for (int i = 0; i < 3 && box; ++i) most[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor((*box)[i] / width));
    std::int64_t const largest = *std::max_element(most.begin(), most.end());
    std::vector<Vec3> cells;
    // The coarsest grid that has room, so that few chains spread over the box and a lone one lies in its middle.
    for (auto n = static_cast<std::int64_t>(std::ceil(std::cbrt(static_cast<double>(wanted)) - 1e-9)); cells.size() < wanted; ++n) {
        cells = grid.clear_cells({std::min(n, most[0]), std::min(n, most[1]), std::min(n, most[2])}, wanted);
        if (n >= largest) break;
    }
    if (cells.size() == wanted) return cells;
    fail(node,
         fmt::format("the box {:.6g} x {:.6g} x {:.6g} has room for {} chains side by side, each within a sphere {:.4g} wide, not for {}",
                     (*box)[0], (*box)[1], (*box)[2], cells.size(), width, wanted),
         "enlarge the box, lower `count` or start from compacter `positions`; denser packings are not in this version");
}

}  // namespace

void place_side_by_side(std::vector<Draft>& drafts, std::optional<Vec3> const& box) {
    std::vector<Draft*> movable;
    for (Draft& draft : drafts)
        if (draft.movable) movable.push_back(&draft);
    if (movable.empty()) return;
    std::vector<Sphere> placed, moving;
    double width = 0;
    for (Draft const& draft : drafts) {
        Sphere const sphere = sphere_around(draft.chain);
        (draft.movable ? moving : placed).push_back(sphere);
        if (draft.movable) width = std::max(width, 2 * sphere.radius + sphere.gap);
    }
    if (width == 0) width = 1;  // lone beads: any distance will do
    Grid const grid(placed, width, box);
    std::vector<Vec3> const cells = find_cells(grid, movable.size(), width, box, *movable.front()->node);
    for (std::size_t i = 0; i < movable.size(); ++i) move(movable[i]->chain, cells[i] - moving[i].centre);
}

}  // namespace catena::scene
