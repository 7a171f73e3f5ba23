// ClosedSteps: time steps that left a constraint violation are repeated, with as many sweeps as
// close the joints.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "integrate/chain_system.hpp"
#include "integrate/constrained_integrator.hpp"

namespace catena {

/// Checks constraint violation and repeats steps that exceed the tolerance.
/// Each rank records its violation after every step. Ranks agree on it only in look(), since
/// collective operations cost more than computing the violation. If it exceeded the tolerance, the
/// steps since the previous look() are repeated. Steps that leave joints open get further sweeps.
/// The states are thus those of a run that looked after every step.
class ClosedSteps {
  public:
    /// `tolerance`: largest relative constraint violation. Both references must outlive this
    /// object.
    ClosedSteps(ChainSystem& system, ConstrainedIntegrator& integrator, double tolerance);
    /// Records the violation after step n. Does nothing on a GPU, where a check costs as much as a
    /// step. Rigid bodies, whose check takes longer, are checked after each of the first steps and
    /// at every eighth step later.
    void note(std::int64_t n);
    /// Checks the violation at step n, which must be prepared. Repeats the steps since the previous
    /// look() if some exceeded the tolerance; `prepare` was then the last thing to be called.
    /// Returns the present violation, or a larger one that repeated steps were left with.
    /// Throws ComputationError that names the step if no number of sweeps closes the joints. Throws
    /// it also if a pivot failure occurred and steps cannot be repeated. Collective.
    double look(std::int64_t n, std::function<void()> const& prepare);
    /// Repeats the steps since the previous look() if some left joints open, after `prepare` failed
    /// at step n on all ranks. Returns true if steps were repeated. Collective.
    bool mend(std::int64_t n, std::function<void()> const& prepare);
    /// Returns the violation at the present positions, the same on all ranks. It is NaN if a
    /// position is not finite or a pivot failure occurred. Collective.
    double error();
    /// Returns the number of steps with further sweeps, the first of them, and the most sweeps;
    /// null if there were none.
    nlohmann::json summary() const;
    /// Returns the summary as a sentence; empty if there were no such steps.
    std::string text() const;

  private:
    /// True if a state before step n was kept.
    bool can_repeat(std::int64_t n) const { return kept_ && kept_->step < n; }
    /// Repeats the steps from the kept one to n.
    void repeat(std::int64_t n, std::function<void()> const& prepare);
    /// Takes step n, with further sweeps and parts until the joints close.
    void take(std::int64_t n, std::function<void()> const& prepare);
    /// Returns how much rounding of coordinates may contribute to the relative violation.
    double rounding_at(ConstrainedIntegrator::Kept const&) const;
    /// True if the state at step n may be kept.
    bool can_keep(std::int64_t n) const;

    /// One group's drifts.
    struct Group {
        ClosingDrifts* drifts;
        bool beads;
    };
    /// State from which steps can be repeated.
    struct Start {
        std::int64_t step;
        ConstrainedIntegrator::Kept state;
    };
    /// Only the first steps on a GPU can be repeated, because copying the state takes long. Rigid
    /// bodies are checked after each of `first_steps` steps, then at every `every_of_bodies`-th.
    static constexpr std::int64_t first_steps = 128, every_of_bodies = 8;
    ChainSystem& system_;
    ConstrainedIntegrator& integrator_;
    std::vector<Group> groups_;
    double tolerance_;
    std::optional<Start> kept_;
    /// Largest violation of this rank since the last look(), and largest violation beyond the
    /// tolerance left by repeated steps.
    double worst_since_ = 0, left_open_ = 0;
    // number of steps with further sweeps, and the first of them
    std::int64_t steps_ = 0, first_ = 0;
    int most_sweeps_ = 0;
    std::string trouble_;  // this rank's pivot failure, as found by error(); empty if there is none
};

}  // namespace catena
