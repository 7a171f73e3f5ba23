// Implements predictions by interpolation between measured sizes.
#include "plan/planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catena::plan {
namespace {

/// Sizes at which chains are measured: `first`, and then each `step` times the previous one.
struct Sizes {
    std::int64_t first, step;
    /// Returns the measured sizes next to `bodies` from below and above, or the two largest.
    std::array<std::int64_t, 2> around(std::int64_t bodies, std::int64_t largest) const {
        std::int64_t low = first;
        while (low * step < bodies && low * step * step <= largest) low *= step;
        return {low, std::min(low * step, std::max(low, largest))};
    }
    /// Returns the sizes up to the first one that reaches `bodies`, none above `largest`.
    std::vector<std::int64_t> up_to(std::int64_t bodies, std::int64_t largest) const {
        std::vector<std::int64_t> all;
        for (std::int64_t n = first; n <= largest; n *= step) {
            all.push_back(n);
            if (n >= bodies) break;
        }
        return all;
    }
};
/// Sizes for whole evaluations and for levels of the pairwise tree.
constexpr Sizes of_evaluations{16, 4}, of_levels{2, 8};

/// Measures the missing points of a curve at these numbers of bodies and returns the curve.
template <class Points, class Numbers, class Measure>
Points const& measured_at(Points& curve, Numbers const& numbers, Measure const& measure) {
    for (std::int64_t const n : numbers)
        if (!curve.has(n)) curve.add(n, measure(n));
    return curve;
}

}  // namespace

PhaseCurve const& Planner::phases_of(Family const& family, Arrangement const& arrangement,
                                     std::int64_t bodies) {
    return measured_at(calibration_.of(family, arrangement),
                       of_evaluations.around(bodies, largest(family, arrangement)),
                       [&](std::int64_t n) { return machine_.measure(family, n, arrangement); });
}

DriftCurve const& Planner::drifts_of(Family const& family, Arrangement const& arrangement,
                                     std::int64_t bodies) {
    return measured_at(
        calibration_.of_drifts(family, arrangement),
        of_evaluations.around(bodies, largest(family, arrangement)),
        [&](std::int64_t n) { return machine_.measure_drifts(family, n, arrangement); });
}

LevelCurve const& Planner::levels_of(Family const& family, Place place, std::int64_t bodies) {
    return measured_at(calibration_.of(family, place, machine_.threads),
                       of_levels.up_to(bodies, largest_), [&](std::int64_t n) {
                           return machine_.measure_levels(family, n, place, machine_.threads);
                       });
}

Prediction Planner::predict(std::vector<Share> const& shares, Arrangement const& arrangement) {
    Prediction found{arrangement, {}, true, {}};
    try {
        for (Share const& share : shares) {
            PhaseSeconds const own =
                phases_of(share.family, arrangement, share.bodies).at(share.bodies);
            for (std::size_t p = 0; p < phases; ++p) found.seconds[p] += own[p];
        }
    } catch (std::exception const& error) {
        if (!uses_gpu(arrangement.backend)) throw;
        // For example, the program has no kernels for this GPU, or the GPU has no memory left.
        found.unusable = error.what();
    }
    return found;
}

DriftSeconds Planner::predict_drifts(std::vector<Share> const& shares,
                                     Arrangement const& arrangement) {
    DriftSeconds sum{};
    for (Share const& share : shares) {
        DriftSeconds const own =
            drifts_of(share.family, arrangement, share.bodies).at(share.bodies);
        for (std::size_t c = 0; c < drift_costs; ++c) sum[c] += own[c];
    }
    return sum;
}

std::vector<Prediction> Planner::predict(std::vector<Share> const& shares) {
    std::vector<Prediction> all;
    for (Arrangement const& arrangement : machine_.alike)
        all.push_back(predict(shares, arrangement));
    for (Arrangement const& arrangement : machine_.others) {
        all.push_back(predict(shares, arrangement));
        all.back().alike = false;
    }
    return all;
}

LevelPlan Planner::plan_levels(std::vector<Share> const& shares, Place gpu) {
    std::vector<LevelledShare> levelled;
    for (Share const& share : shares)
        levelled.push_back({share, levels_of(share.family, Place::host, share.bodies),
                            levels_of(share.family, gpu, share.bodies)});
    return LevelPlan(levelled);
}

Prediction Planner::predict(std::vector<Share> const& shares, LevelPlan const& levels,
                            GpuLevels cut) {
    // The host computes everything outside the tree with its threads.
    Arrangement const host =
        machine_.threads > 1 ? Arrangement{Backend::openmp, machine_.threads} : Arrangement{};
    Prediction found = predict(shares, host);
    found.arrangement = {Backend::cuda_levels, machine_.threads};
    found.alike = false;
    found.seconds[matrix_sweep] = found.seconds[bias_sweep] = std::nan("");
    found.seconds[evaluation] = found.seconds[typical_evaluation] =
        found.seconds[kinematics] + levels.seconds(cut);
    return found;
}

void Planner::measure_everything() {
    for (Family const& family : all_families()) {
        for (auto const* list : {&machine_.alike, &machine_.others})
            for (Arrangement const& arrangement : *list)
                for (std::int64_t const n : of_evaluations.up_to(largest(family, arrangement),
                                                                 largest(family, arrangement))) {
                    phases_of(family, arrangement, n);
                    if (family.axes == Axes::world) drifts_of(family, arrangement, n);
                }
        levels_of(family, Place::host, largest_);
        if (machine_.no_gpu.empty()) levels_of(family, Place::gpu, largest_);
    }
}

Prediction const& quickest(std::vector<Prediction> const& predictions, double beside) {
    // A switch must save a tenth: fewer threads wait less and leave more cores to other programs.
    double constexpr worth_it = 0.9;
    Prediction const* best = nullptr;
    for (Prediction const& p : predictions) {
        if (!p.alike || !p.unusable.empty()) continue;
        if (!best || beside + p.seconds[typical_evaluation] <
                         worth_it * (beside + best->seconds[typical_evaluation]))
            best = &p;
    }
    return *best;
}

}  // namespace catena::plan
