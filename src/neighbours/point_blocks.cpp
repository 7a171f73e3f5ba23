// Formation of blocks of points.
#include "neighbours/point_blocks.hpp"

#include <algorithm>

namespace catena {
namespace {

/// Bounding box of points.
struct Box {
    explicit Box(Vec3 const& x) : least(x), most(x) {}
    void add(Vec3 const& x) {
        for (int c = 0; c < 3; ++c) {
            least[c] = std::min(least[c], x[c]);
            most[c] = std::max(most[c], x[c]);
        }
    }
    void add(Box const& other) {
        add(other.least);
        add(other.most);
    }
    /// Longest edge.
    double edge() const {
        return std::max({most[0] - least[0], most[1] - least[1], most[2] - least[2]});
    }

    Vec3 least, most;
};

Box box_of(std::span<Vec3 const> points) {
    Box box(points.front());
    for (Vec3 const& x : points.subspan(1)) box.add(x);
    return box;
}

/// Returns the block whose box contains [least, most] in spite of the rounding of its midpoint.
PointBlock block(Box const& box, std::int64_t begin, std::int64_t end) {
    PointBlock b{0.5 * (box.least + box.most), {}, begin, end};
    for (int c = 0; c < 3; ++c)
        b.half[c] = std::max(box.most[c] - b.middle[c], b.middle[c] - box.least[c]);
    return b;
}

}  // namespace

std::vector<PointBlock> blocks_of(PointGroups const& groups, double edge) {
    std::size_t constexpr most_points = 32;
    std::vector<PointBlock> blocks;
    for (std::int64_t begin = 0; begin < groups.size();) {
        std::int64_t end = begin + 1;
        std::size_t points = groups.group(begin).size();
        if (points > 0) {
            Box box = box_of(groups.group(begin));
            for (; end < groups.size(); ++end) {
                std::span<Vec3 const> const next = groups.group(end);
                points += next.size();
                if (next.empty()) continue;
                Box wider = box;
                wider.add(box_of(next));
                if (points > most_points || wider.edge() > edge) break;
                box = wider;
            }
            blocks.push_back(block(box, begin, end));
        }
        begin = end;
    }
    return blocks;
}

}  // namespace catena
