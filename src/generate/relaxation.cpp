// Implements relax(): capped forces under link constraints separate the overlaps that growth
// leaves.
#include <algorithm>
#include <span>
#include <utility>

#include "generate/cells.hpp"
#include "generate/crowd.hpp"
#include "generate/link_projection.hpp"

namespace catena::scene {

namespace {

/// Range of the push in excluded distances. A range slightly above 1 lets the relaxation end in
/// finitely many steps.
double constexpr push_reach = 1.02;
/// Skin of the neighbour list in excluded distances. The list is rebuilt when a bead has moved half
/// as far.
double constexpr skin = 0.2;
/// Fraction of an overlap that each bead of a pair moves in one step.
double constexpr stiffness = 0.4;
/// Largest displacement of a bead in one step, in excluded distances.
double constexpr cap = 0.1;

/// Neighbour list with a skin. It holds the pairs that can come within range before a bead has
/// moved by half the skin. Link neighbours and pairs of fixed points are left out.
class Pairs {
  public:
    void list(Crowd const& crowd) {
        double const width = (push_reach + skin) * crowd.excluded;
        Images const images(crowd.box);
        Cells const cells(crowd.box, width, crowd.at.size());
        sort(crowd, images, cells);
        pairs_.clear();
        for (std::uint32_t const i : order_) {
            if (i >= crowd.movable()) continue;
            cells.any_around(wrapped_[i], [&](std::size_t cell) {
                for (std::uint32_t at = begin_[cell]; at < begin_[cell + 1]; ++at) {
                    std::uint32_t const j = order_[at];
                    if (j <= i || crowd.linked(i, j)) continue;
                    Vec3 const apart = images.shortest(wrapped_[i] - wrapped_[j]);
                    if (dot(apart, apart) < width * width) pairs_.emplace_back(i, j);
                }
                return false;
            });
        }
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> const& all() const { return pairs_; }

  private:
    /// Sorts the points by their cells.
    void sort(Crowd const& crowd, Images const& images, Cells const& cells) {
        std::size_t const n = crowd.at.size();
        wrapped_.resize(n), order_.resize(n);
        begin_.assign(cells.size() + 1, 0);
        std::vector<std::uint32_t> cell(n);
        for (std::size_t i = 0; i < n; ++i) {
            wrapped_[i] = images.wrapped(crowd.at[i]);
            cell[i] = static_cast<std::uint32_t>(cells.of(wrapped_[i]));
            ++begin_[cell[i] + 1];
        }
        for (std::size_t c = 0; c < cells.size(); ++c) begin_[c + 1] += begin_[c];
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::size_t i = 0; i < n; ++i) order_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
    }

    std::vector<Vec3> wrapped_;
    std::vector<std::uint32_t> begin_, order_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

/// State of a relaxation: positions, neighbour list and displacements.
class Relaxation {
  public:
    explicit Relaxation(Crowd& crowd) : crowd_(crowd), images_(crowd.box), parent_(crowd.parent) {
        for (std::size_t c = 0; c < crowd.chains() && !parent_.empty(); ++c)
            for (std::size_t i = crowd.first[c] + 1; i < crowd.first[c + 1]; ++i)
                parent_[i] -= static_cast<std::int64_t>(crowd.first[c]);
        relist();
    }

    /// Counts the overlaps and computes the displacements that reduce them. Rebuilds the neighbour
    /// list if needed.
    Relaxed look() {
        if (moved() > 0.5 * skin * crowd_.excluded) relist();
        double const reach = push_reach * crowd_.excluded,
                     enough = crowd_.excluded * crowd_.excluded;
        push_.assign(crowd_.at.size(), Vec3::zero());
        Relaxed found;
        double nearest = enough;
        for (auto const& [i, j] : pairs_.all()) {
            Vec3 const apart = images_.shortest(crowd_.at[i] - crowd_.at[j]);
            double const square = dot(apart, apart);
            if (square >= reach * reach) continue;
            if (square < enough) ++found.overlaps, nearest = std::min(nearest, square);
            double const distance = std::sqrt(square);
            Vec3 const direction = distance > 0 ? (1 / distance) * apart : Vec3{{0, 0, 1}};
            bool const alone = j >= crowd_.movable();
            double const way = (alone ? 2 : 1) * stiffness * (reach - distance);
            push_[i] = plus_scaled(push_[i], way, direction);
            if (!alone) push_[j] = plus_scaled(push_[j], -way, direction);
        }
        found.nearest = std::sqrt(nearest);
        found.outside = push_inside();
        return found;
    }

    /// Moves the beads, each by at most the cap, and projects the links to their lengths.
    void step() {
        double const furthest = cap * crowd_.excluded;
        for (std::size_t i = 0; i < crowd_.movable(); ++i) {
            double const way = norm(push_[i]);
            if (way > 0)
                crowd_.at[i] =
                    plus_scaled(crowd_.at[i], way > furthest ? furthest / way : 1, push_[i]);
        }
        for (std::size_t c = 0; c < crowd_.chains(); ++c) {
            std::size_t const begin = crowd_.first[c], beads = crowd_.first[c + 1] - begin;
            std::span const all(parent_);
            links_.project({std::span(crowd_.at).subspan(begin, beads),
                            std::span(crowd_.length).subspan(begin, beads),
                            {},
                            {},
                            {},
                            0,
                            all.empty() ? all : all.subspan(begin, beads)});
        }
    }

  private:
    /// Adds the displacements of beads at their walls. Returns the number of beads beyond them.
    std::int64_t push_inside() {
        double const margin = (push_reach - 1) * crowd_.excluded;
        std::int64_t beyond = 0;
        for (std::size_t c = 0; c < crowd_.walls.size(); ++c)
            for (std::size_t i = crowd_.first[c]; i < crowd_.first[c + 1]; ++i) {
                Vec3 const& at = crowd_.at[i];
                beyond += crowd_.outside(c, at) > 0 ? 1 : 0;
                for (int axis = 0; axis < 3; ++axis) {
                    Range const range = crowd_.range(c, axis);
                    double const way = 2 * stiffness * (range.beyond(at[axis]) + margin);
                    if (way > 0) push_[i][axis] += at[axis] - range.low < margin ? way : -way;
                }
            }
        return beyond;
    }

    void relist() {
        pairs_.list(crowd_);
        listed_ = crowd_.at;
    }
    /// Largest displacement since the neighbour list was built.
    double moved() const {
        double most = 0;
        for (std::size_t i = 0; i < crowd_.movable(); ++i) {
            Vec3 const way = crowd_.at[i] - listed_[i];
            most = std::max(most, dot(way, way));
        }
        return std::sqrt(most);
    }

    Crowd& crowd_;
    Images images_;
    /// Crowd::parent, counted from the first bead of each chain.
    std::vector<std::int64_t> parent_;
    Pairs pairs_;
    LinkProjection links_;
    std::vector<Vec3> listed_, push_;
};

}  // namespace

Relaxed relax(Crowd& crowd, std::int64_t most_steps) {
    Relaxation relaxation(crowd);
    for (std::int64_t steps = 0;; ++steps) {
        Relaxed found = relaxation.look();
        found.steps = steps;
        bool const done = found.overlaps == 0 && found.outside == 0;
        if (done || steps == most_steps) return found;
        relaxation.step();
    }
}

}  // namespace catena::scene
