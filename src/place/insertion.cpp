// Implements the random insertion of chains that keep their shape: places are tried one after the
// other until one is clear of all points so far.
#include "place/insertion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "generate/conformation.hpp"
#include "generate/occupied.hpp"
#include "generate/outline.hpp"
#include "generate/random.hpp"
#include "place/chain_motion.hpp"

namespace catena::scene {

namespace {

/// Largest number of places to try for one chain.
int constexpr most_trials = 5000;
/// Factor between the thicknesses that the search for an advice tries.
double constexpr thicker = 1.15;

/// A chain that keeps its shape.
struct Shape {
    std::size_t draft = 0;
    std::vector<Vec3> points;  // from the centre
    Vec3 centre = Vec3::zero();
    double clearance = 0;  // smallest distance from other chains
    bool rotatable = false;
};

/// Rotation about the shape's centre, then the place of the centre.
struct Motion {
    Quat rotation = Quat::identity();
    Vec3 centre = Vec3::zero();
};

/// Longest link, without the distances from a rigid domain's centre of mass to its first and last
/// bead.
double longest_link(ChainSpec const& chain, Outline const& outline) {
    if (!chain.is_linked() || chain.linked.length.empty()) return outline.link;
    return *std::max_element(chain.linked.length.begin(), chain.linked.length.end());
}

Shape shape_of(Draft const& draft, std::size_t number, double least) {
    Outline const outline = outline_of(draft.chain);
    Shape shape{number, outline.points, Vec3::zero(),
                std::max(least, longest_link(draft.chain, outline)), is_rotatable(draft.chain)};
    for (Vec3 const& point : shape.points)
        shape.centre =
            plus_scaled(shape.centre, 1 / static_cast<double>(shape.points.size()), point);
    for (Vec3& point : shape.points) point = point - shape.centre;
    return shape;
}

/// Inserts shapes into a box, among points that have a place.
class Insertion {
  public:
    Insertion(std::vector<Shape> const& shapes, std::vector<Vec3> const& placed, Vec3 const& box,
              std::uint64_t seed)
        : shapes_(shapes),
          box_(box),
          seed_(seed),
          occupied_(box, width_of(shapes, box), placed.size() + points_of(shapes)) {
        for (Vec3 const& point : placed) occupied_.put(next_++, point);
    }

    /// Finds a place for shape k in the region, or returns nothing.
    std::optional<Motion> insert(std::size_t k, Region const& region) {
        Shape const& shape = shapes_[k];
        std::vector<Vec3> at(shape.points.size());
        for (int trial = 0; trial < most_trials; ++trial) {
            Draws draws(seed_, static_cast<std::int64_t>(k), static_cast<std::uint64_t>(trial));
            Motion motion;
            if (shape.rotatable) motion.rotation = draws.rotation();
            Mat3 const r = to_matrix(motion.rotation);
            std::transform(shape.points.begin(), shape.points.end(), at.begin(),
                           [&](Vec3 const& point) { return r * point; });
            if (!draw_centre(at, shape.clearance, region, draws, motion.centre)) continue;
            for (Vec3& point : at) point = point + motion.centre;
            if (!is_clear(at, shape.clearance)) continue;
            for (Vec3 const& point : at) occupied_.put(next_++, point);
            return motion;
        }
        return std::nullopt;
    }

  private:
    /// Width of a cell: the largest clearance. Single beads without any may stand anywhere.
    static double width_of(std::vector<Shape> const& shapes, Vec3 const& box) {
        double width = 0;
        for (Shape const& shape : shapes) width = std::max(width, shape.clearance);
        return width > 0 ? width : std::min({box[0], box[1], box[2]});
    }
    static std::size_t points_of(std::vector<Shape> const& shapes) {
        return std::accumulate(
            shapes.begin(), shapes.end(), std::size_t{0},
            [](std::size_t sum, Shape const& shape) { return sum + shape.points.size(); });
    }

    /// Draws a centre for points around the origin. Returns false if they do not fit between the
    /// walls, or meet their own images.
    bool draw_centre(std::vector<Vec3> const& points, double clearance, Region const& region,
                     Draws& draws, Vec3& centre) const {
        for (int axis = 0; axis < 3; ++axis) {
            auto const [least, most] = std::minmax_element(
                points.begin(), points.end(),
                [axis](Vec3 const& a, Vec3 const& b) { return a[axis] < b[axis]; });
            double const low = (*least)[axis], high = (*most)[axis];
            bool const walled = region.walled[static_cast<std::size_t>(axis)];
            double const from = region.low[axis] - (walled ? low : 0),
                         to = region.high[axis] - (walled ? high : 0);
            if (to < from || high - low + clearance > box_[axis]) return false;
            centre[axis] = draws.between(from, to);
        }
        return true;
    }
    bool is_clear(std::vector<Vec3> const& points, double clearance) const {
        double const enough = clearance * clearance;
        return std::all_of(points.begin(), points.end(), [&](Vec3 const& point) {
            return occupied_.clearance(point, Occupied::none, 0.999999 * enough, enough) >= enough;
        });
    }

    std::vector<Shape> const& shapes_;
    Vec3 box_;
    std::uint64_t seed_;
    Occupied occupied_;
    /// Number of the next point.
    std::size_t next_ = 0;
};

/// All shapes and the points around which they are inserted.
struct Task {
    std::vector<Shape> shapes;
    std::vector<Vec3> placed;
    Vec3 box;
    std::uint64_t seed;
};

Task task_of(std::vector<Draft> const& drafts, Vec3 const& box, std::uint64_t seed, double least) {
    /// Stream of the insertion, distinct from the streams of single chains and of the packing.
    std::uint64_t constexpr insertion = std::uint64_t{3} << 62;
    Task task{{}, {}, box, seed_of_stream(seed, insertion)};
    for (std::size_t d = 0; d < drafts.size(); ++d) {
        if (!drafts[d].movable) {
            std::vector<Vec3> const points = outline_of(drafts[d].chain).points;
            task.placed.insert(task.placed.end(), points.begin(), points.end());
        } else if (drafts[d].regrown != Regrowth::yes) {
            task.shapes.push_back(shape_of(drafts[d], d, least));
        }
    }
    std::stable_sort(task.shapes.begin(), task.shapes.end(), [](Shape const& a, Shape const& b) {
        return a.points.size() > b.points.size();
    });
    return task;
}

/// Inserts all shapes; `region(draft)` is the region of each. The motions end with the last shape
/// that found a place.
template <class RegionOf>
std::vector<Motion> insert_all(Task const& task, RegionOf const& region) {
    Insertion insertion(task.shapes, task.placed, task.box, task.seed);
    std::vector<Motion> motions;
    for (std::size_t k = 0; k < task.shapes.size(); ++k) {
        std::optional<Motion> const found = insertion.insert(k, region(task.shapes[k].draft));
        if (!found) break;
        motions.push_back(*found);
    }
    return motions;
}

/// Advice for a slab that had no room. Tries thicker ones until all shapes fit.
std::string advice_on_slab(Task const& task, std::vector<Draft> const& drafts, Region const& slab) {
    double const edge = task.box[slab.slab];
    for (double t = thicker * slab.extent()[slab.slab]; t < edge; t *= thicker) {
        auto const region = [&](std::size_t draft) {
            Region const& own = *drafts[draft].region;
            return own.node == slab.node ? with_thickness(own, t) : own;
        };
        if (insert_all(task, region).size() == task.shapes.size())
            return advice_on_thickness(slab, task.box, t);
    }
    return "lower the number of chains, or give a longer box and a thicker slab";
}

/// Moves the drafts of all shapes to their places.
void move_to(std::vector<Draft>& drafts, Task const& task, std::vector<Motion> const& motions) {
    for (std::size_t k = 0; k < motions.size(); ++k) {
        Shape const& shape = task.shapes[k];
        ChainSpec& chain = drafts[shape.draft].chain;
        if (shape.rotatable) rotate(chain, motions[k].rotation, shape.centre);
        translate(chain, motions[k].centre - shape.centre);
    }
}

[[noreturn]] void refuse(Task const& task, std::vector<Draft> const& drafts, std::size_t placed) {
    Draft const& draft = drafts[task.shapes[placed].draft];
    Region const& region = *draft.region;
    fail(region.node ? *region.node : *draft.node,
         fmt::format("{} of {} chains that keep their shape found a place in {}, chain `{}` found "
                     "none in {} trials",
                     placed, task.shapes.size(), region.name(), shown(draft.chain.name),
                     most_trials),
         region.slab >= 0 ? advice_on_slab(task, drafts, region)
                          : "enlarge it or lower the number of chains");
}

}  // namespace

void insert_shapes(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed) {
    Task const task = task_of(drafts, box, seed, excluded_distance);
    if (task.shapes.empty()) return;
    std::vector<Motion> const motions =
        insert_all(task, [&](std::size_t draft) -> Region const& { return *drafts[draft].region; });
    if (motions.size() < task.shapes.size()) refuse(task, drafts, motions.size());
    move_to(drafts, task, motions);
}

std::size_t insert_if_all_fit(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed,
                              double least) {
    Task const task = task_of(drafts, box, seed, least);
    Region const whole = whole_box(box);
    std::vector<Motion> const motions =
        insert_all(task, [&](std::size_t) -> Region const& { return whole; });
    if (motions.size() == task.shapes.size()) move_to(drafts, task, motions);
    return motions.size();
}

}  // namespace catena::scene
