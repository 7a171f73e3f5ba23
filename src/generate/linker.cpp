// Implements the growth of linkers. Each new bead lies on the part of the sphere around the last
// one from which the remaining links reach the other end.
#include "generate/linker.hpp"

#include <algorithm>
#include <cmath>

#include "generate/cell_stack.hpp"
#include "generate/random.hpp"

namespace catena::scene {

namespace {

/// Trials for one bead, and for the whole linker by number of beads.
constexpr int trials_a_bead = 64;
constexpr std::int64_t trials_a_linker = 20000;

/// A unit vector at right angles to `axis`, at the angle `turn` around it.
Vec3 across(Vec3 const& axis, double turn) {
    Vec3 const helper = std::abs(axis[0]) < 0.6 ? Vec3{{1, 0, 0}} : Vec3{{0, 1, 0}};
    Vec3 const raw = cross(axis, helper);
    Vec3 const first = (1 / norm(raw)) * raw, second = cross(axis, first);
    return std::cos(turn) * first + std::sin(turn) * second;
}

/// Grows one linker.
class Growing {
  public:
    Growing(Linker const& linker, std::span<Vec3 const> others, std::uint64_t seed)
        : linker_(linker), seed_(seed), grown_(linker.excluded) {
        for (Vec3 const& other : others) grown_.push(other);
        grown_.push(linker.from);
        base_ = grown_.size();
        double const contour = linker.length * static_cast<double>(linker.beads + 1);
        stretch_ = std::min(1.0, 1.1 * norm(linker.to - linker.from) / contour);
    }

    std::vector<Vec3> grow() {
        std::int64_t furthest = 0, retreat = 1;
        while (placed() < linker_.beads) {
            if (attempt_ > static_cast<std::uint64_t>(trials_a_linker * (linker_.beads + 9)))
                return {};
            bool const found = place_one();
            if (placed() > furthest) {
                furthest = placed();
                retreat = 1;
            }
            if (found) continue;
            // The retreat doubles with each failure, so that the walk leaves any dead end.
            for (std::int64_t i = 0; i < retreat && placed() > 0; ++i) grown_.pop();
            retreat = std::min(2 * retreat, linker_.beads);
        }
        std::vector<Vec3> all = grown_.take();
        all.erase(all.begin(), all.begin() + base_);
        return all;
    }

  private:
    std::int64_t placed() const { return grown_.size() - base_; }

    bool place_one() {
        for (int trial = 0; trial < trials_a_bead; ++trial) {
            Vec3 const at = candidate();
            bool const last = placed() + 1 == linker_.beads;
            if ((!last && norm(at - linker_.to) < linker_.excluded) || grown_.crowded(at)) continue;
            grown_.push(at);
            return true;
        }
        return false;
    }

    /// Largest distance from the end at which `links` links remain. Long linkers stay within the
    /// reach of a random walk, or else they would return on a straight line.
    double reach(std::int64_t links) const {
        auto const n = static_cast<double>(links);
        return linker_.length * n * std::max(stretch_, std::min(1.0, 2 * std::pow(n, -0.4)));
    }

    /// A point one link from the top, within reach of the end; for the last bead one link from the
    /// end, too.
    Vec3 candidate() {
        Draws draws(seed_, placed(), attempt_++);
        Vec3 const way = linker_.to - grown_.top();
        double const distance = norm(way), l = linker_.length;
        Vec3 const axis = (1 / distance) * way;
        std::int64_t const links = linker_.beads - placed();  // after this bead
        double const r = reach(links);
        double const least =
            std::clamp((l * l + distance * distance - r * r) / (2 * l * distance), -1.0, 1.0);
        double const along = links == 1 ? least : draws.between(least, 1);
        double const beside = std::sqrt(std::max(0.0, 1 - along * along));
        return grown_.top() +
               l * (along * axis + beside * across(axis, 2 * Draws::pi * draws.uniform()));
    }

    Linker const& linker_;
    std::uint64_t seed_, attempt_ = 0;
    CellStack grown_;
    std::int64_t base_ = 0;
    /// Part of the linker's contour that its ends are apart, with a margin.
    double stretch_ = 1;
};

}  // namespace

std::vector<Vec3> grow_linker(Linker const& linker, std::span<Vec3 const> others,
                              std::uint64_t seed) {
    return Growing(linker, others, seed).grow();
}

}  // namespace catena::scene
