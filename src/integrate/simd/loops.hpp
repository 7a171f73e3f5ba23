// Loops of JointLoops over vectors of `Real`.
#pragma once

#include "dca/simd/abreast.hpp"
#include "integrate/joint_lanes.hpp"

namespace catena {

template <class Real, bool positions>
struct LoopsOf {
    using Bodies = dca::Abreast<Real>;
    [[gnu::flatten]] static void set_relative(JointChains const& chains, std::int64_t const* first, std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) chains.template set_relative<positions>(Bodies{first[i]});
    }
    [[gnu::flatten]] static void set_motion(JointChains const& chains, std::int64_t const* first, std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) chains.template set_motion<positions>(Bodies{first[i]}, false);
    }
    [[gnu::flatten]] static void set_rates(JointChains const& chains, RatesView const& out, std::int64_t const* first, std::int64_t begin,
                                           std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) chains.set_rates(Bodies{first[i]}, out);
    }
    [[gnu::flatten]] static void runge_kutta(JointSteps const& steps, RungeKuttaStage const& stage, std::int64_t const* first,
                                             std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) steps.template runge_kutta<positions>(Bodies{first[i]}, stage);
    }
    [[gnu::flatten]] static void embedded_stage(EmbeddedSteps const& steps, EmbeddedStage const& stage, std::int64_t const* first,
                                                std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) steps.template advance<positions>(Bodies{first[i]}, stage);
    }
    static constexpr JointLoops loops() { return {set_relative, set_motion, set_rates, runge_kutta, embedded_stage}; }
};

template <class Real>
JointLoops joint_loops(bool positions) {
    return positions ? LoopsOf<Real, true>::loops() : LoopsOf<Real, false>::loops();
}

}  // namespace catena
