// How near to the exact answer a chain comes, in either precision and after steps of refinement,
// and how long that takes.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "measure/growth.hpp"
#include "measure/timing.hpp"
#include "tests/bench/precision/chain.hpp"

namespace catena::precision {

inline constexpr int most_steps = 3;

/// After 0, 1, ... steps of refinement in double.
struct Errors {
    bool definite = true;  // the matrices were
    std::array<double, most_steps + 1> error{}, residual{};
};

/// A scene of one chain and what it is compared with.
class Problem {
  public:
    /// `nudges`: of exact_solution().
    Problem(Scene, int nudges);
    std::optional<Joint> joint() const { return joint_; }
    bool fits(int lanes) const { return precision::fits(*group_, lanes); }
    ChainInArrays arrays(Kernels const& kernels) const { return ChainInArrays(*group_, kernels); }
    /// Leaves the chain's configuration and loads there.
    Errors errors(ChainInArrays&) const;
    /// One evaluation by the library's own solver, with loads and kinematics made ready.
    std::function<void()> library_evaluation(SimdLevel) const;
    ExactSolution const& exact() const { return exact_; }
    /// 32 depth eps.
    double residual_bound() const;

  private:
    Errors errors_of_beads(StudiedSolver&, std::unique_ptr<ChainSolver>) const;
    double error_of(std::vector<Vec3> const& accelerations, Vec3 const& base) const;

    Scene scene_;
    std::unique_ptr<Communicator> communicator_;
    std::unique_ptr<Executor> executor_;
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    ChainGroup const* group_;
    std::optional<Joint> joint_;
    Solution layout_;
    ExactSolution exact_;
};

/// Processor seconds, medians; in one run, in turns, each after one of its own that is not timed.
struct Times {
    double matrix = 0, bias = 0, defect = 0;  // a sweep; what a step of refinement looks at
    std::array<double, most_steps + 1> evaluation{};
};
struct AllTimes {
    Times in_double, in_single;
    double library = 0;
};
AllTimes times_of(ChainInArrays const& in_double, ChainInArrays const& in_single,
                  std::function<void()> library, int repeat);

/// Steps after which single precision's error is at most twice that of double precision without
/// refinement (but for one rounding): their roundings differ.
std::optional<int> steps_needed(Errors const& in_double, Errors const& in_single);
/// What becomes of single precision's matrices: "1 step", "2 steps", "not within 3", "diverges",
/// "not finite" (its error is infinite or not a number), "indefinite".
std::string outcome(Errors const& in_double, Errors const& in_single);

}  // namespace catena::precision
