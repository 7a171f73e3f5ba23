#include "dca/simd/side_by_side.hpp"

namespace catena::dca {
namespace {

bool is_regular(ChainGroup const& group, Run const& run) {
    if (run.count != longest_run) return false;
    for (std::int64_t k = run.body; k < run.body + run.count; ++k) {
        auto const i = static_cast<std::size_t>(k);
        if (group.is_first[i] || group.is_last[i]) return false;
        if (k > run.body && group.restricted_of_joint[i] != group.directions) return false;
    }
    return true;
}

}  // namespace

RunsDealtOut deal_out_runs(ChainGroup const& group, int lanes) {
    RunsDealtOut dealt;
    int lane = lanes;
    for (Run const& run : group.schedule.runs) {
        if (!is_regular(group, run)) {
            dealt.others.push_back(run);
            continue;
        }
        if (lane == lanes) {
            dealt.items.emplace_back();
            lane = 0;
        }
        RunsInLanes& item = dealt.items.back();
        for (int same = lane; same < lanes; ++same) item.body[same] = run.body, item.slot[same] = run.slot, item.next[same] = run.next;
        ++lane;
    }
    return dealt;
}

std::vector<LevelDealtOut> deal_out_levels(ChainGroup const& group, int lanes) {
    std::vector<LevelDealtOut> all;
    for (std::vector<Merge> const& level : group.schedule.levels) {
        LevelDealtOut& dealt = all.emplace_back(LevelDealtOut{{}, {{}}});
        int lane = lanes;
        for (Merge const& m : level) {
            if (!rounds_as_vectors() || group.restricted_of_joint[static_cast<std::size_t>(m.joint)] != group.directions) {
                dealt.others.front().push_back(m);
                continue;
            }
            if (lane == lanes) {
                dealt.items.emplace_back();
                lane = 0;
            }
            MergesInLanes& item = dealt.items.back();
            for (int same = lane; same < lanes; ++same) {
                item.inboard[same] = m.inboard, item.outboard[same] = m.outboard, item.slot[same] = m.slot;
                item.first[same] = m.first, item.joint[same] = m.joint, item.next[same] = m.next;
            }
            ++lane;
        }
    }
    return all;
}

}  // namespace catena::dca
