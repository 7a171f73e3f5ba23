// Distribution of runs and merges to SIMD lanes (side_by_side.hpp).
#include "dca/simd/side_by_side.hpp"

namespace catena::dca {
namespace {

/// True if the run may be processed side by side with others.
bool is_regular(ChainGroup const& group, Run const& run, RunsTaken const& taken) {
    std::int64_t const last = run.body + run.count - 1;
    if (run.count > longest_run || run.count < (taken.of_parts ? part_length : longest_run) ||
        group.ends.has_jointed_tip(last))
        return false;
    auto const at = [](std::int64_t k) { return static_cast<std::size_t>(k); };
    if (taken.read_neighbours &&
        (group.ends.is_first[at(run.body)] || group.ends.is_last[at(last)]))
        return false;
    for (std::int64_t k = run.body + 1; k <= last; ++k)
        if (group.joints.restricted[at(k)] != group.directions) return false;
    return true;
}

/// Numbers of runs on all ranks. Ranks know the lengths of other ranks' chains, but not their
/// joints.
struct RunsOfGroup {
    std::int64_t whole = 0, shorter = 0;
    explicit RunsOfGroup(ChainGroup const& group) {
        for (ChainTree const& tree : group.partition.trees) {
            std::int64_t const whole_ones = tree.bodies / longest_run;
            whole += whole_ones;
            shorter += tree.runs - whole_ones;
        }
    }
    /// True if vectors save time. One or two runs take less time one after the other than in a
    /// vector with most lanes idle.
    bool enough() const { return whole + shorter >= few; }
    /// True if shorter runs save time as well: if there are enough of them, or if the last vector
    /// of whole runs has free lanes for all.
    bool shorter_ones_pay() const {
        return shorter >= few ||
               (whole % most_lanes > 0 && whole % most_lanes + shorter <= most_lanes);
    }

  private:
    static constexpr std::int64_t few = 3;
};

/// Number of merges from which on the last, incomplete vector of a level takes less time than
/// single merges.
constexpr std::size_t few_merges = 3;

}  // namespace

bool prefetches(ChainGroup const& group) {
    // Estimated bytes per body and per bead, and bytes that stay in the caches. Measured with a
    // cache of 32 MiB: without prefetching, 16,384 bodies take a tenth less time, 32,768 bodies
    // half as much again.
    constexpr std::int64_t of_body = 1200, of_bead = 300, kept = std::int64_t{24} << 20;
    return group.size * (group.beads ? of_bead : of_body) > kept;
}

RunsDealtOut deal_out_runs(ChainGroup const& group, int lanes, RunsTaken const& taken) {
    RunsDealtOut dealt;
    int lane = lanes;
    RunsOfGroup const all(group);
    RunsTaken const pay{taken.of_parts && all.shorter_ones_pay(), taken.read_neighbours};
    for (Run const& run : group.schedule.runs) {
        if (!all.enough() || !is_regular(group, run, pay)) {
            dealt.others.push_back(run);
            continue;
        }
        if (lane == lanes) {
            dealt.items.emplace_back();
            lane = 0;
        }
        RunsInLanes& item = dealt.items.back();
        int const skipped = static_cast<int>(longest_run - run.count);
        // The first run of an item fills all lanes, so that free lanes repeat it.
        for (int j = lane; j < (lane == 0 ? lanes : lane + 1); ++j) {
            item.body[j] = run.body, item.slot[j] = run.slot, item.next[j] = run.next;
            item.column[j] = run.body - skipped, item.skipped[j] = skipped;
        }
        ++lane;
    }
    for (RunsInLanes& item : dealt.items)
        for (int j = 0; j < lanes; ++j) {
            auto const bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(j));
            item.begins[0] |= bit;
            item.begins[item.skipped[j]] |= bit;
            if (item.skipped[j] > 0) item.late |= bit;
        }
    return dealt;
}

std::vector<LevelDealtOut> deal_out_levels(ChainGroup const& group, int lanes) {
    std::vector<LevelDealtOut> all;
    for (std::vector<Merge> const& level : group.schedule.levels) {
        LevelDealtOut& dealt = all.emplace_back(LevelDealtOut{{}, {{}}});
        std::vector<Merge> alike;
        for (Merge const& m : level) {
            // Merges in vectors require that the rest of the program rounds as vectors do.
            // Otherwise the distribution to ranks could change the results.
            bool const goes =
                rounds_as_vectors() &&
                group.joints.restricted[static_cast<std::size_t>(m.joint)] == group.directions;
            (goes ? alike : dealt.others.front()).push_back(m);
        }
        std::size_t const left_over = alike.size() % static_cast<std::size_t>(lanes);
        if (left_over < few_merges) {
            dealt.others.front().insert(dealt.others.front().end(),
                                        alike.end() - static_cast<std::ptrdiff_t>(left_over),
                                        alike.end());
            alike.resize(alike.size() - left_over);
        }
        for (std::size_t i = 0; i < alike.size(); ++i) {
            std::size_t const lane = i % static_cast<std::size_t>(lanes);
            if (lane == 0) dealt.items.emplace_back();
            MergesInLanes& item = dealt.items.back();
            Merge const& m = alike[i];
            for (std::size_t same = lane; same < static_cast<std::size_t>(lanes); ++same) {
                item.inboard[same] = m.inboard, item.outboard[same] = m.outboard,
                item.slot[same] = m.slot;
                item.first[same] = m.first, item.joint[same] = m.joint, item.next[same] = m.next;
            }
        }
    }
    return all;
}

}  // namespace catena::dca
