// Implements extended and self-avoiding conformations and the lengths of links.
#include "generate/conformation.hpp"

#include <cmath>
#include <limits>
#include <unordered_map>

#include "generate/random.hpp"

namespace catena::scene {

namespace {

/// Stack of points in cubic cells of the excluded distance. Only the point pushed last can be
/// popped.
class CellStack {
  public:
    explicit CellStack(double width) : width_(width) {}

    std::int64_t size() const { return static_cast<std::int64_t>(points_.size()); }
    Vec3 const& top() const { return points_.back(); }

    /// Adds a point on top of the stack.
    void push(Vec3 const& point) {
        auto [head, fresh] = heads_.try_emplace(key(point, 0, 0, 0), -1);
        next_.push_back(head->second);
        head->second = size();
        points_.push_back(point);
    }
    void pop() {
        heads_[key(points_.back(), 0, 0, 0)] = next_.back();
        next_.pop_back();
        points_.pop_back();
    }
    /// True if a point other than the last one is nearer than the width.
    bool crowded(Vec3 const& point) const {
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    auto const head = heads_.find(key(point, x, y, z));
                    if (head != heads_.end() && crowded_by(point, head->second)) return true;
                }
        return false;
    }
    std::vector<Vec3> take() { return std::move(points_); }

  private:
    bool crowded_by(Vec3 const& point, std::int64_t k) const {
        for (; k >= 0; k = next_[static_cast<std::size_t>(k)])
            if (k + 1 != size() && norm(points_[static_cast<std::size_t>(k)] - point) < width_)
                return true;
        return false;
    }
    /// Key of the cell shifted by (x, y, z) cells from the point's cell: 21 bits per axis. Distant
    /// cells may share a key, which only costs time.
    std::uint64_t key(Vec3 const& p, int x, int y, int z) const {
        auto const cell = [&](double coordinate, int shift) {
            return static_cast<std::uint64_t>(
                       static_cast<std::int64_t>(std::floor(coordinate / width_)) + shift) &
                   0x1FFFFF;
        };
        return cell(p[0], x) << 42 | cell(p[1], y) << 21 | cell(p[2], z);
    }

    double width_;
    std::vector<Vec3> points_;
    std::vector<std::int64_t> next_;
    std::unordered_map<std::uint64_t, std::int64_t> heads_;
};

/// Inboard end of link k (from 0): the preceding bead, or the anchor.
Vec3 inboard_of(BeadArrays const& beads, std::size_t k) {
    return k == 0 ? beads.anchor : beads.position[k - 1];
}

}  // namespace

std::vector<Vec3> extended_conformation(std::int64_t points, double length) {
    std::vector<Vec3> at(static_cast<std::size_t>(points));
    double const along = std::sqrt(0.75) * length, across = 0.5 * length;
    for (std::int64_t k = 0; k < points; ++k)
        at[static_cast<std::size_t>(k)] = {
            {static_cast<double>(k) * along, k % 2 == 0 ? 0.0 : across, 0}};
    return at;
}

std::vector<Vec3> self_avoiding_conformation(std::int64_t points, double length, double excluded,
                                             std::uint64_t seed) {
    CellStack grown(excluded);
    grown.push(Vec3::zero());
    std::int64_t furthest = 1, retreat = 1;
    std::uint64_t attempt = 0;
    while (grown.size() < points) {
        bool found = false;
        for (int trial = 0; trial < 64 && !found; ++trial) {
            Vec3 const candidate =
                plus_scaled(grown.top(), length, Draws(seed, grown.size(), attempt++).on_sphere());
            if (found = !grown.crowded(candidate); found) grown.push(candidate);
        }
        if (grown.size() > furthest) {
            furthest = grown.size();
            retreat = 1;
        }
        // The retreat doubles with each failure, so that the walk leaves any dead end.
        if (!found) {
            for (std::int64_t i = 0; i < retreat && grown.size() > 1; ++i) grown.pop();
            retreat *= 2;
        }
    }
    return grown.take();
}

void take_lengths(BeadArrays& beads, Base base) {
    beads.length.assign(beads.size(), 0.0);
    for (std::size_t k = base == Base::fixed ? 0 : 1; k < beads.size(); ++k)
        beads.length[k] = norm(beads.position[k] - inboard_of(beads, k));
}

std::int64_t coincident_bead(BeadArrays const& beads, Base base) {
    for (std::size_t k = base == Base::fixed ? 0 : 1; k < beads.size(); ++k) {
        Vec3 const from = inboard_of(beads, k);
        // Positions are rounded to half a unit in their last place. A link shorter than a few of
        // these units has no direction.
        double const rounding =
            16 * std::numeric_limits<double>::epsilon() * (norm(from) + norm(beads.position[k]));
        if (!(norm(beads.position[k] - from) > rounding)) return static_cast<std::int64_t>(k);
    }
    return -1;
}

}  // namespace catena::scene
