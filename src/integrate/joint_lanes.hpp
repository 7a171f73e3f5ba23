// Loops over the bodies of chains in joint coordinates, as many at a time as a vector has lanes: which bodies, and the loops of an
// instruction set. What these do is in joint_chains.hpp, joint_steps.hpp and embedded_steps.hpp.
#pragma once

#include <cstdint>
#include <vector>

#include "dca/host_space.hpp"
#include "integrate/embedded_steps.hpp"

namespace catena {

/// For the bodies at first[i], first[i] + 1, ... that fill a vector, i in [begin, end). With or without positions, as JointChains says.
struct JointLoops {
    void (*set_relative)(JointChains const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    void (*set_motion)(JointChains const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    void (*set_rates)(JointChains const&, RatesView const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    void (*runge_kutta)(JointSteps const&, RungeKuttaStage const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    void (*embedded_stage)(EmbeddedSteps const&, EmbeddedStage const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
};
/// Precondition: simd_levels() has them.
JointLoops avx2_joint_loops(bool positions);
JointLoops avx512_joint_loops(bool positions);

class JointLanes {
  public:
    /// `springs`: whether joints have any.
    JointLanes(ChainGroup const&, bool springs, SimdLevel);

    /// Whether any bodies go side by side.
    bool any() const { return !first_.empty(); }
    /// some(loops, first, begin, end) for those, one(k) for the others.
    template <class Space, class Some, class One>
    void each(Space const& space, bool positions, Some const& some, One const& one) const {
        JointLoops const& loops = loops_[positions ? 1 : 0];
        space.over_ranges(std::ssize(first_), 2, [&](std::int64_t begin, std::int64_t end) { some(loops, first_.data(), begin, end); });
        space.over(typename Space::template List<std::int64_t>(others_), [&one](std::int64_t k) CATENA_WHOLE { one(k); });
    }

  private:
    JointLoops loops_[2]{};
    std::vector<std::int64_t> first_, others_;
};

}  // namespace catena
