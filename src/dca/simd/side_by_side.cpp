#include "dca/simd/side_by_side.hpp"

namespace catena::dca {
namespace {

bool is_regular(ChainGroup const& group, Run const& run, bool read_neighbours) {
    std::int64_t const last = run.body + run.count - 1;
    if (run.count != longest_run || group.has_jointed_tip(last)) return false;
    auto const at = [](std::int64_t k) { return static_cast<std::size_t>(k); };
    if (read_neighbours && (group.is_first[at(run.body)] || group.is_last[at(last)])) return false;
    for (std::int64_t k = run.body + 1; k <= last; ++k)
        if (group.restricted_of_joint[at(k)] != group.directions) return false;
    return true;
}

/// One or two take less time one after the other than a vector with most of its lanes idle. All runs count: ranks know how long others'
/// chains are, not their joints.
bool has_enough_runs(ChainGroup const& group) {
    std::int64_t runs = 0;
    for (ChainTree const& tree : group.partition.trees) runs += tree.runs;
    return runs >= 3;
}

/// So many left over of a level take less time one after the other.
constexpr std::size_t few_merges = 3;

}  // namespace

RunsDealtOut deal_out_runs(ChainGroup const& group, int lanes, bool read_neighbours) {
    RunsDealtOut dealt;
    int lane = lanes;
    bool const enough = has_enough_runs(group);
    for (Run const& run : group.schedule.runs) {
        if (!enough || !is_regular(group, run, read_neighbours)) {
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
        std::vector<Merge> alike;
        for (Merge const& m : level) {
            bool const goes = rounds_as_vectors() && group.restricted_of_joint[static_cast<std::size_t>(m.joint)] == group.directions;
            (goes ? alike : dealt.others.front()).push_back(m);
        }
        std::size_t const left_over = alike.size() % static_cast<std::size_t>(lanes);
        if (left_over < few_merges) {
            dealt.others.front().insert(dealt.others.front().end(), alike.end() - static_cast<std::ptrdiff_t>(left_over), alike.end());
            alike.resize(alike.size() - left_over);
        }
        for (std::size_t i = 0; i < alike.size(); ++i) {
            std::size_t const lane = i % static_cast<std::size_t>(lanes);
            if (lane == 0) dealt.items.emplace_back();
            MergesInLanes& item = dealt.items.back();
            Merge const& m = alike[i];
            for (std::size_t same = lane; same < static_cast<std::size_t>(lanes); ++same) {
                item.inboard[same] = m.inboard, item.outboard[same] = m.outboard, item.slot[same] = m.slot;
                item.first[same] = m.first, item.joint[same] = m.joint, item.next[same] = m.next;
            }
        }
    }
    return all;
}

}  // namespace catena::dca
