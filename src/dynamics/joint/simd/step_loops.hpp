// Implementation of StepLoops for vectors of type `Real`, compiled for one instruction set by each
// source that includes it.
#pragma once

#include "dca/simd/abreast.hpp"
#include "dynamics/joint/joint_lanes.hpp"

namespace catena {

/// StepLoops::set_rates for one vector type.
template <class Real>
[[gnu::flatten]] void set_rates(JointChains const& chains, RatesView const& out,
                                BodyLanes const& bodies, std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
        chains.set_rates(dca::Abreast<Real>{bodies.first[i], bodies.prefetches}, out);
}

/// The other loops for one vector type, with or without positions.
template <class Real, bool positions>
struct StepLoopsOf {
    using Bodies = dca::Abreast<Real>;
    [[gnu::flatten]] static void accumulate(JointSteps const& steps, WeightedStage const& stage,
                                            BodyLanes const& bodies, std::int64_t begin,
                                            std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i)
            steps.template accumulate<positions>(Bodies{bodies.first[i], bodies.prefetches}, stage);
    }
    [[gnu::flatten]] static void embedded_stage(EmbeddedSteps const& steps,
                                                EmbeddedStage const& stage, BodyLanes const& bodies,
                                                std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i)
            steps.template advance<positions>(Bodies{bodies.first[i], bodies.prefetches}, stage);
    }
    static constexpr StepLoops table() { return {set_rates<Real>, accumulate, embedded_stage}; }
};

/// Table of loops with or without positions.
template <class Real>
StepLoops step_loops(bool positions) {
    return positions ? StepLoopsOf<Real, true>::table() : StepLoopsOf<Real, false>::table();
}

}  // namespace catena
