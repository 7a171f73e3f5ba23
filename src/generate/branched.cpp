// Implements the shapes of branched chains and their growth.
#include "generate/branched.hpp"

#include <algorithm>
#include <cmath>

#include "generate/cell_stack.hpp"
#include "generate/crowd.hpp"
#include "generate/link_projection.hpp"
#include "generate/random.hpp"

namespace catena::scene {

namespace {

/// Stream of a random tree's shape, distinct from those of its positions and sizes.
std::uint64_t constexpr shape_stream = std::uint64_t{1} << 62;
/// Number of places that are tried for each bead, and for each that takes the one with the least
/// overlap.
int constexpr trials = 64, trials_of_crowded = 8;
/// Largest number of relaxation steps, times the number of beads; at least `least_relaxed` steps.
std::int64_t constexpr most_relaxed = 10'000'000, least_relaxed = 20;
/// The same where more links end on a bead than fit, so that overlaps stay.
std::int64_t constexpr most_relaxed_of_full = 200'000;
/// Overlaps are relaxed if at most one bead in this number has one: denser trees have no start
/// without overlaps nearby.
std::int64_t constexpr most_crowded = 4;
/// Room beside a tree in its relaxation, in excluded distances.
double constexpr room = 10;

/// Largest part of the sphere around a bead that caps of its links may cover.
double constexpr most_covered = 0.85;

using Inboard = std::vector<std::int64_t>;

/// Appends a row of beads that begins at bead `from`; returns its last bead.
std::int64_t add_row(Inboard& inboard, std::int64_t from, std::int64_t beads) {
    for (std::int64_t i = 0; i < beads; ++i) {
        inboard.push_back(from);
        from = std::ssize(inboard) - 1;
    }
    return from;
}

Inboard inboard_for(Star const& star, std::uint64_t) {
    Inboard inboard{-1};
    for (std::int64_t arm = 0; arm < star.arms; ++arm) add_row(inboard, 0, star.arm_length);
    return inboard;
}

Inboard inboard_for(Brush const& brush, std::uint64_t) {
    Inboard inboard;
    add_row(inboard, -1, brush.backbone);
    for (std::int64_t bead = 0; bead < brush.backbone; bead += brush.every)
        add_row(inboard, bead, brush.side_length);
    return inboard;
}

Inboard inboard_for(Dendrimer const& tree, std::uint64_t) {
    Inboard inboard{-1}, ends{0};
    for (std::int64_t g = 0; g < tree.generations; ++g) {
        Inboard further;
        for (std::int64_t const end : ends)
            for (std::int64_t i = g == 0 ? 0 : 1; i < tree.functionality; ++i)
                further.push_back(add_row(inboard, end, tree.spacer + 1));
        ends = std::move(further);
    }
    return inboard;
}

Inboard inboard_for(RandomTree const& tree, std::uint64_t seed) {
    Inboard inboard{-1}, open{0};
    std::vector<std::int64_t> children{0};
    for (std::int64_t k = 1; k < tree.beads; ++k) {
        Draws draws(seed_of_stream(seed, shape_stream), k);
        auto const drawn =
            static_cast<std::size_t>(draws.uniform() * static_cast<double>(open.size()));
        std::int64_t const on = open[drawn];
        inboard.push_back(on);
        children.push_back(0);
        if (++children[static_cast<std::size_t>(on)] == tree.max_children) {
            open[drawn] = open.back();
            open.pop_back();
        }
        open.push_back(k);
    }
    return inboard;
}

/// True if more links of `length` end on a bead than random growth finds room for: ends of links
/// that are `excluded` apart have disjoint caps around the bead, which cannot cover it. 12 caps of
/// 60 degrees, the most that fit, cover 0.804.
bool has_full_bead(Inboard const& inboard, std::vector<double> const& length, double excluded) {
    std::vector<double> taken(inboard.size(), 0.0);  // parts of the sphere
    for (std::size_t k = 1; k < inboard.size(); ++k) {
        double const sine = std::min(1.0, excluded / (2 * length[k])),
                     cap = (1 - std::sqrt(1 - sine * sine)) / 2;
        if ((taken[static_cast<std::size_t>(inboard[k])] += cap) > most_covered) return true;
    }
    return false;
}

double count_of(Star const& star) {
    return 1 + static_cast<double>(star.arms) * static_cast<double>(star.arm_length);
}
double count_of(Brush const& brush) {
    std::int64_t const sides = (brush.backbone - 1) / brush.every + 1;
    return static_cast<double>(brush.backbone) +
           static_cast<double>(sides) * static_cast<double>(brush.side_length);
}
double count_of(Dendrimer const& tree) {
    double segments = 0, last = static_cast<double>(tree.functionality);
    for (std::int64_t g = 0; g < tree.generations && std::isfinite(segments); ++g) {
        segments += last;
        last *= static_cast<double>(tree.functionality - 1);
    }
    return 1 + segments * static_cast<double>(tree.spacer + 1);
}
double count_of(RandomTree const& tree) { return static_cast<double>(tree.beads); }

/// Grows one tree. Points are the beads, after the anchor of a fixed base.
class TreeGrowth {
  public:
    /// `parent`, `length`: of each point; those of the first one are not used. A `full` tree takes
    /// no steps back, which would not help.
    TreeGrowth(Inboard const& parent, std::vector<double> const& length, double excluded, bool full,
               std::uint64_t seed)
        : parent_(parent),
          length_(length),
          excluded_(excluded),
          seed_(seed),
          grown_(excluded > 0 ? excluded : 1),
          allowance_(full ? 0 : std::ssize(parent)) {}

    /// Returns the points, the first one at `start`.
    std::vector<Vec3> run(Vec3 const& start) {
        grown_.push(start);
        while (grown_.size() < std::ssize(parent_))
            if (!extend()) step_back();
        return grown_.take();
    }
    Overlaps const& overlaps() const { return overlaps_; }

  private:
    /// Adds the next point at a free place. Without one it returns false or, if the tree may not
    /// step back any more, takes the place with the least overlap.
    bool extend() {
        auto const next = static_cast<std::size_t>(grown_.size());
        std::int64_t const on = parent_[next];
        double clear = -1;
        Vec3 place = Vec3::zero();
        int const most = allowance_ > 0 ? trials : trials_of_crowded;
        for (int trial = 0; trial < most && clear < excluded_; ++trial) {
            Draws draws(seed_, grown_.size(), attempt_++);
            Vec3 const candidate = plus_scaled(grown_.at(on), length_[next], draws.on_sphere());
            double const found = excluded_ > 0 ? grown_.clearance(candidate, on, clear) : excluded_;
            if (found > clear) clear = found, place = candidate;
        }
        if (clear < excluded_) {
            if (allowance_ > 0) return false;
            overlaps_.nearest = overlaps_.count++ == 0 ? clear : std::min(overlaps_.nearest, clear);
        }
        grown_.push(place);
        if (grown_.size() > furthest_) furthest_ = grown_.size(), retreat_ = 1;
        return true;
    }

    /// Removes the last points. Their number doubles with each failure, so that the tree leaves any
    /// dead end.
    void step_back() {
        std::int64_t const back = std::min({retreat_, grown_.size() - 1, allowance_});
        for (std::int64_t i = 0; i < back; ++i) grown_.pop();
        // Without a point to remove, new attempts count instead.
        allowance_ -= std::max<std::int64_t>(back, 1);
        retreat_ = std::min(2 * retreat_, std::ssize(parent_));
    }

    Inboard const& parent_;
    std::vector<double> const& length_;
    double excluded_;
    std::uint64_t seed_, attempt_ = 0;
    CellStack grown_;
    std::int64_t allowance_, furthest_ = 0, retreat_ = 1;
    Overlaps overlaps_;
};

/// Pushes overlapping points apart at constant lengths of the links; returns what is left. `most`
/// is the largest number of steps, times the number of points.
Overlaps relaxed(std::vector<Vec3>& points, Inboard const& parent, std::vector<double> length,
                 double excluded, std::int64_t most) {
    Vec3 low = points[0], high = low;
    for (Vec3 const& p : points)
        for (int i = 0; i < 3; ++i)
            low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    Crowd crowd;
    for (int i = 0; i < 3; ++i) crowd.box[i] = high[i] - low[i] + room * excluded;
    crowd.excluded = excluded;
    crowd.at = points;
    crowd.length = std::move(length);
    crowd.first = {0, points.size()};
    crowd.parent = parent;
    Relaxed const found = relax(crowd, std::max(least_relaxed, most / std::ssize(points)));
    for (std::size_t k = 0; k < points.size(); ++k)
        points[k] = points[0] + (crowd.at[k] - crowd.at[0]);
    return {found.overlaps, found.nearest};
}

}  // namespace

double beads_of(BranchedShape const& shape) {
    return std::visit([](auto const& of) { return count_of(of); }, shape);
}

std::vector<std::int64_t> inboard_beads(BranchedShape const& shape, std::uint64_t seed) {
    return std::visit([&](auto const& of) { return inboard_for(of, seed); }, shape);
}

Overlaps grow_tree(BeadArrays& beads, TreeRoot const& root, Inboard const& inboard,
                   double excluded) {
    Inboard const parent = unit_parents(inboard, root.base);
    std::ptrdiff_t const anchors = root.base == Base::fixed ? 1 : 0;
    std::vector<double> length(static_cast<std::size_t>(anchors), 0.0);
    length.insert(length.end(), beads.length.begin(), beads.length.end());
    bool const full = has_full_bead(parent, length, excluded);
    TreeGrowth growth(parent, length, excluded, full, root.seed);
    std::vector<Vec3> points = growth.run(root.anchor);
    Overlaps left = growth.overlaps();
    if (left.count > 0 && left.count <= std::ssize(beads.mass) / most_crowded)
        left = relaxed(points, parent, std::move(length), excluded,
                       full ? most_relaxed_of_full : most_relaxed);
    beads.position.assign(points.begin() + anchors, points.end());
    return left;
}

}  // namespace catena::scene
