// A stack of points that finds neighbours by cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// Stack of points in cubic cells of the excluded distance. Only the point pushed last can be
/// popped.
class CellStack {
  public:
    /// `width` is the excluded distance and the edge of the cells.
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
    /// Removes the point that was pushed last.
    void pop() {
        heads_[key(points_.back(), 0, 0, 0)] = next_.back();
        next_.pop_back();
        points_.pop_back();
    }
    /// True if a point other than the last one is nearer than the width.
    bool crowded(Vec3 const& point) const {
        return for_each_around(
            point, [&](std::int64_t k) { return k + 1 != size() && norm(at(k) - point) < width_; });
    }
    /// Point k, in the order of pushing.
    Vec3 const& at(std::int64_t k) const { return points_[static_cast<std::size_t>(k)]; }
    /// Returns the distance of the nearest point among those nearer than the width, except point
    /// `passed_over`; infinite if there is none. The search ends early once the result is at most
    /// `least`; it then returns any such value.
    double clearance(Vec3 const& place, std::int64_t passed_over, double least) const {
        double found = std::numeric_limits<double>::infinity();
        for_each_around(place, [&](std::int64_t k) {
            double const distance = norm(at(k) - place);
            if (k != passed_over && distance < width_) found = std::min(found, distance);
            return found <= least;
        });
        return found;
    }
    /// Moves the points out, in the order of pushing.
    std::vector<Vec3> take() { return std::move(points_); }

  private:
    /// Calls visit(k) for the points in the cells around a place until it returns true; returns
    /// whether it did.
    template <class Visit>
    bool for_each_around(Vec3 const& place, Visit const& visit) const {
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    auto const head = heads_.find(key(place, x, y, z));
                    if (head == heads_.end()) continue;
                    for (std::int64_t k = head->second; k >= 0;
                         k = next_[static_cast<std::size_t>(k)])
                        if (visit(k)) return true;
                }
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

}  // namespace catena::scene
