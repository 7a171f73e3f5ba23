// Steps that left joints open are taken again, with as many sweeps as close them.
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

/// How far joints are open is noted on each rank after every step and agreed upon at looks alone,
/// since collectives cost more than the error. Where it exceeded the tolerance, the steps since the
/// look before are taken again from there, each that leaves joints open with further sweeps: the
/// states are those of a run that had looked after every step.
class ClosedSteps {
  public:
    ClosedSteps(ChainSystem& system, ConstrainedIntegrator& integrator, double tolerance);
    /// After step n. On a GPU, where a look costs as much as a step, nothing; rigid bodies, whose
    /// joints take longer to look at, are looked at after each of the first steps and then now and
    /// again.
    void note(std::int64_t n);
    /// At step n, prepared. Returns the error there, or what steps before were left with beyond the
    /// tolerance; what took steps again has called `prepare` last. Collective. Throws
    /// ComputationError that names the step where no number of sweeps closes the joints, or where
    /// matrices are lost and steps cannot be taken again.
    double look(std::int64_t n, std::function<void()> const& prepare);
    /// At step n, which could not be prepared, as all ranks know: steps since the look before that
    /// left joints open are taken again. Returns whether there were any. Collective.
    bool mend(std::int64_t n, std::function<void()> const& prepare);
    /// At the positions of now; NaN where a position is none or matrices are lost. The same on all
    /// ranks. Collective.
    double error();
    /// Steps that took further sweeps: how many, from which on, the most sweeps; null of none.
    nlohmann::json summary() const;
    /// The same in a sentence; empty of none.
    std::string text() const;

  private:
    bool can_repeat(std::int64_t n) const { return kept_ && kept_->step < n; }
    void repeat(std::int64_t n, std::function<void()> const& prepare);
    void take(std::int64_t n, std::function<void()> const& prepare);
    double rounding_at(ConstrainedIntegrator::Kept const&) const;
    bool can_keep(std::int64_t n) const;

    struct Group {
        ClosingDrifts* drifts;
        bool beads;
    };
    struct Start {
        std::int64_t step;
        ConstrainedIntegrator::Kept state;
    };
    /// On a GPU, whose state is long in coming, the first steps alone can be taken again.
    static constexpr std::int64_t first_steps = 128, every_of_bodies = 8;
    ChainSystem& system_;
    ConstrainedIntegrator& integrator_;
    std::vector<Group> groups_;
    double tolerance_;
    std::optional<Start> kept_;
    double worst_since_ = 0,
           left_open_ =
               0;  // before steps were taken again, on this rank; after that, beyond the tolerance
    std::int64_t steps_ = 0, first_ = 0;
    int most_sweeps_ = 0;
    std::string trouble_;  // of this rank's matrices, as error() found it
};

}  // namespace catena
