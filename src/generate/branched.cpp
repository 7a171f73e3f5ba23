// Implements the shapes of branched chains and their growth.
#include "generate/branched.hpp"

#include <algorithm>
#include <cmath>

#include "generate/cell_stack.hpp"
#include "generate/random.hpp"

namespace catena::scene {

namespace {

/// Stream of a random tree's shape, distinct from those of its positions and sizes.
std::uint64_t constexpr shape_stream = std::uint64_t{1} << 62;
/// Number of places that are tried for each bead.
int constexpr trials = 64;

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
    TreeGrowth(BeadArrays& beads, Walk const& walk, Inboard const& inboard, double excluded)
        : beads_(beads),
          inboard_(inboard),
          seed_(walk.seed),
          anchored_(walk.base == Base::fixed ? 1 : 0),
          excluded_(excluded),
          grown_(excluded > 0 ? excluded : 1),
          allowance_(walk.beads) {
        grown_.push(walk.anchor);  // the anchor itself, or bead 1 of a free base
    }

    void run(Crowding& crowding) {
        auto const points = std::ssize(inboard_) + anchored_;
        while (grown_.size() < points)
            if (!extend(crowding)) step_back();
        std::vector<Vec3> const points_grown = grown_.take();
        beads_.position.assign(points_grown.begin() + anchored_, points_grown.end());
    }

  private:
    /// Adds the next bead at a free place. Without one it returns false or, if the tree may not
    /// step back any more, takes the place with the least overlap.
    bool extend(Crowding& crowding) {
        auto const bead = static_cast<std::size_t>(grown_.size() - anchored_);
        std::int64_t const on = bead == 0 ? 0 : inboard_[bead] + anchored_;
        CellStack::Nearest best{-1, -1};
        Vec3 place = Vec3::zero();
        for (int trial = 0; trial < trials && best.distance < excluded_; ++trial) {
            Draws draws(seed_, grown_.size(), attempt_++);
            Vec3 const candidate =
                plus_scaled(grown_.at(on), beads_.length[bead], draws.on_sphere());
            CellStack::Nearest const found = grown_.nearest(candidate, on);
            if (found.distance > best.distance) best = found, place = candidate;
        }
        if (best.distance < excluded_) {
            if (allowance_ > 0) return false;
            note(crowding, best, static_cast<std::int64_t>(bead));
        }
        grown_.push(place);
        if (grown_.size() > furthest_) furthest_ = grown_.size(), retreat_ = 1;
        return true;
    }

    /// Removes the last beads. Their number doubles with each failure, so that the tree leaves any
    /// dead end.
    void step_back() {
        std::int64_t const back = std::min({retreat_, grown_.size() - 1, allowance_});
        for (std::int64_t i = 0; i < back; ++i) grown_.pop();
        // Without a bead to remove, new attempts count instead.
        allowance_ -= std::max<std::int64_t>(back, 1);
        retreat_ *= 2;
    }

    void note(Crowding& crowding, CellStack::Nearest const& near, std::int64_t bead) const {
        if (crowding.beads++ > 0 && !(near.distance < crowding.distance)) return;
        crowding.first = near.point - anchored_;
        crowding.second = bead;
        crowding.distance = near.distance;
    }

    BeadArrays& beads_;
    Inboard const& inboard_;
    std::uint64_t seed_, attempt_ = 0;
    std::int64_t anchored_;
    double excluded_;
    CellStack grown_;
    std::int64_t allowance_, furthest_ = 0, retreat_ = 1;
};

}  // namespace

double beads_of(BranchedShape const& shape) {
    return std::visit([](auto const& of) { return count_of(of); }, shape);
}

std::vector<std::int64_t> inboard_beads(BranchedShape const& shape, std::uint64_t seed) {
    return std::visit([&](auto const& of) { return inboard_for(of, seed); }, shape);
}

BeadArrays grown_tree(Walk const& walk, std::vector<std::int64_t> const& inboard, double excluded,
                      Crowding& crowding) {
    BeadArrays beads = drawn_sizes(walk);
    TreeGrowth(beads, walk, inboard, excluded).run(crowding);
    return beads;
}

}  // namespace catena::scene
