// Implements the plan of levels: sums over groups and the search for the best cut.
#include "plan/level_plan.hpp"

#include <numeric>

namespace catena::plan {

LevelPlan::LevelPlan(std::vector<LevelledShare> const& shares) : rows_(1), shares_(shares) {
    for (LevelledShare const& each : shares) add(each);
}

void LevelPlan::add(LevelledShare const& each) {
    Share const& share = each.share;
    LevelSeconds const host = each.host.at(share.bodies), gpu = each.gpu.at(share.bodies);
    rows_[0].items += share.bodies;
    rows_[0].host_up += host[bodies_up], rows_[0].host_down += host[bodies_down];
    rows_[0].gpu_up += gpu[bodies_up], rows_[0].gpu_down += gpu[bodies_down];
    views_ += gpu[views];
    rows_.resize(std::max(rows_.size(), share.merges.size() + 1));
    // Number of segments below the level.
    std::int64_t segments = share.bodies;
    for (std::size_t l = 1; l < rows_.size(); ++l) {
        LevelRow& row = rows_[l];
        std::int64_t const merges = l <= share.merges.size() ? share.merges[l - 1] : 0;
        segments = std::max<std::int64_t>(1, segments - merges);
        LevelSeconds const cut = each.gpu.at(segments);
        row.cut_up += cut[segments_up], row.cut_down += cut[forces_down];
        if (merges == 0) continue;
        LevelSeconds const on_host = each.host.at(2 * merges), on_gpu = each.gpu.at(2 * merges);
        row.items += merges;
        row.host_up += on_host[merges_up], row.host_down += on_host[merges_down];
        row.gpu_up += on_gpu[merges_up], row.gpu_down += on_gpu[merges_down];
    }
}

double LevelPlan::seconds(GpuLevels cut) const {
    int const up = std::min(cut.up, levels()), down = std::min(cut.down, levels());
    double sum = up > 0 || down > 0 ? views_ : 0;
    for (int l = 0; l <= levels(); ++l) {
        LevelRow const& row = rows_[static_cast<std::size_t>(l)];
        sum += up > 0 && l <= up ? row.gpu_up : row.host_up;
        sum += down > 0 && l <= down ? row.gpu_down : row.host_down;
    }
    if (up > 0) sum += rows_[static_cast<std::size_t>(up)].cut_up;
    if (down > 0) sum += rows_[static_cast<std::size_t>(down)].cut_down;
    // Joints that are eliminated in one place and needed in the other cross the cut.
    for (LevelledShare const& each : shares_) {
        std::vector<std::int64_t> const& merges = each.share.merges;
        auto const at = [&](int level) {
            return merges.begin() + std::min<std::ptrdiff_t>(level, std::ssize(merges));
        };
        std::int64_t const between =
            std::accumulate(at(std::min(up, down)), at(std::max(up, down)), std::int64_t{0});
        if (between > 0) sum += each.gpu.at(between)[joints_across];
    }
    return sum;
}

GpuLevels LevelPlan::best() const {
    GpuLevels best{0, 0};
    for (int up = 0; up <= levels(); ++up)
        for (int down = 0; down <= levels(); ++down)
            if (seconds({up, down}) < seconds(best)) best = {up, down};
    return best;
}

}  // namespace catena::plan
