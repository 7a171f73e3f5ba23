// Steppers for integrators in joint coordinates and for constrained integrators.
#include "integrate/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrate/checkpoint_values.hpp"
#include "integrate/closed_steps.hpp"
#include "integrate/constrained_integrator.hpp"
#include "integrate/joint_integrators.hpp"
#include "integrate/step_control.hpp"

namespace catena {
namespace {

using nlohmann::json;

/// Stepper in joint coordinates; its sweeps are corrections of jointed tips and loops.
class JointStepper final : public Stepper {
  public:
    JointStepper(ChainSystem& system, DynamicsSpec const& d)
        : system_(system),
          h_(d.step),
          tolerance_(d.tolerance),
          integrator_(make_joint_integrator(system, d)) {
        sweeps_ = sweeps_a_step(d, has_tips());
        system.close_tips();
    }
    void prepare(StepTimeline*) override { integrator_->prepare(); }
    /// OpenMM's energies are those of its last evaluation, which need not be at the end of a step.
    /// They and joint forces therefore need another evaluation.
    void observe(ObservedQuantities const& asked) override {
        if (!asked.joint_forces && !(asked.energies && system_.openmm())) return;
        system_.evaluate();
        for (int i = 0; i < system_.scene().solver.refine; ++i) system_.refine();
    }
    void step(std::int64_t n, StepTimeline* timeline) override {
        double const start = seconds_now();
        set_time(n);
        integrator_->close_with(corrections_);
        integrator_->step(h_);
        set_time(n + 1);  // the time that a restart computes; sums of inner steps round
        system_.close_tips(corrections_);
        sum_.add(solved(), has_tips() ? corrections_ + 1 : 0);
        if (timeline)
            timeline->phases.push_back({"evaluations", "catena", 0.0, seconds_now() - start});
    }
    /// Only jointed tips and loops can be open in joint coordinates. The result is NaN if the state
    /// is not finite.
    double constraint_error() override {
        double worst = 0;
        for (JointDynamics* const group : system_.joint())
            worst = larger(worst, group->closure_error());
        return worst;
    }
    /// Above a tenth of the tolerance, they get one more correction.
    double early() const override { return 0.1; }
    bool add_sweep() override {
        if (!has_tips() || corrections_ >= most_corrections) return false;
        ++corrections_;
        return true;
    }
    int sweeps() const override { return corrections_; }
    SweepsAStep solved() const override { return integrator_->last_step().value_or(sweeps_); }
    void save(Checkpoint& c) const override {
        c.integers["corrections_of_tips"] = corrections_;
        integrator_->save(c);
    }
    void save(OwnState& own) const override {
        if (!integrator_->carries_rates()) return;
        for (JointDynamics const* const group : system_.joint())
            CheckpointParts(system_).add_rates(group->group(), group->rates(RatesOf::saved), own);
    }
    void branch(Checkpoint const& c) override {
        origin_ = number_in(c, array_of_origin, 0);
        integrator_->set_origin(origin_);
        set_time(c.step);
    }
    void restore(Checkpoint const& c) override {
        branch(c);
        corrections_ = counter_of(c, "corrections_of_tips", 0, most_corrections);
        if (integrator_->carries_rates()) {
            std::vector<JointRates> const rates = CheckpointParts(system_).own_rates(c.arrays);
            std::vector<JointDynamics*> const groups = system_.joint();
            for (std::size_t g = 0; g < groups.size(); ++g) groups[g]->save_rates(rates[g]);
        }
        integrator_->restored(c);
    }
    json describe() const override {
        int const more = has_tips() ? corrections_ + 1 : 0;
        json found = {{"matrix_sweeps_a_step", sweeps_.matrices + more},
                      {"bias_sweeps_a_step", sweeps_.biases + more}};
        if (integrator_->control() && sum_.steps > 0)
            found = {{"matrix_sweeps_a_step", sum_.a_step(sum_.matrices)},
                     {"bias_sweeps_a_step", sum_.a_step(sum_.biases)}};
        if (has_tips()) found["corrections_of_tips"] = corrections_;
        return found;
    }
    json inner_steps() const override {
        StepControl const* const control = integrator_->control();
        if (!control) return nullptr;
        StepControl::Counts const& n = control->counts();
        return {{"tolerance", tolerance_}, {"taken", n.taken},
                {"rejected", n.rejected},  {"shortest", n.shortest},
                {"longest", n.longest},    {"evaluations", sum_.evaluations}};
    }

  private:
    void set_time(std::int64_t step) {
        for (JointDynamics* const group : system_.joint())
            group->set_time(origin_ + static_cast<double>(step) * h_);
    }
    bool has_tips() const {
        auto const groups = system_.joint();
        return std::any_of(groups.begin(), groups.end(),
                           [](JointDynamics const* g) { return g->group().has_closures(); });
    }

    /// Sums over all steps so far.
    struct Sum {
        std::int64_t steps = 0, evaluations = 0, matrices = 0, biases = 0;
        void add(SweepsAStep const& s, int a_closing) {
            ++steps;
            evaluations += s.matrices;
            matrices += s.matrices + s.closings * a_closing;
            biases += s.biases + s.closings * a_closing;
        }
        double a_step(std::int64_t n) const {
            return static_cast<double>(n) / static_cast<double>(steps);
        }
    };

    static constexpr int most_corrections = 10;
    ChainSystem& system_;
    // origin_: time at step 0.
    double h_, tolerance_, origin_ = 0;
    SweepsAStep sweeps_;
    Sum sum_;
    // Corrections of positions of tips and loops after a step.
    int corrections_ = JointDynamics::usual_corrections;
    std::unique_ptr<JointIntegrator> integrator_;
};

/// Stepper of RATTLE and g-BAOAB in absolute coordinates.
class ConstrainedStepper final : public Stepper {
  public:
    ConstrainedStepper(ChainSystem& system, DynamicsSpec const& d)
        : system_(system),
          integrator_({d.integrator, d.step, d.friction, system.scene().boltzmann() * d.temperature,
                       d.seed, d.constraint_tolerance},
                      system.absolute()),
          closed_(system, integrator_, d.constraint_tolerance) {
        for (AbsoluteDynamics* group : system.absolute()) group->update_configuration();
        draw_velocities(d);
    }
    void prepare(StepTimeline* timeline) override {
        double const begin = seconds_now();
        system_.forces_and_matrices(timeline);
        offset_ = seconds_now() - begin;
        if (integrator_.sweeps() == 0) integrator_.choose_sweeps();
    }
    void observe(ObservedQuantities const& asked) override {
        integrator_.observe();
        if (!asked.joint_forces) return;
        for (AbsoluteDynamics* group : system_.absolute()) group->evaluate();
    }
    void step(std::int64_t n, StepTimeline* timeline) override {
        double const start = seconds_now();
        integrator_.step(n);
        if (timeline)
            timeline->phases.push_back(
                {"projections and drift", "catena", offset_, offset_ + seconds_now() - start});
    }
    double constraint_error() override { return closed_.error(); }
    void note_error(std::int64_t n) override { closed_.note(n); }
    double look(std::int64_t n) override {
        return closed_.look(n, [this] { prepare(nullptr); });
    }
    bool mend(std::int64_t n) override {
        return closed_.mend(n, [this] { prepare(nullptr); });
    }
    std::string note_of_sweeps() const override { return closed_.text(); }
    double early() const override { return ConstrainedIntegrator::early; }
    bool add_sweep() override {
        if (integrator_.sweeps() >= ConstrainedIntegrator::most_sweeps) return false;
        integrator_.set_sweeps(integrator_.sweeps() + 1);
        return true;
    }
    int sweeps() const override { return integrator_.sweeps(); }
    int parts() const override { return integrator_.parts(); }
    using Stepper::save;
    void save(Checkpoint& c) const override {
        c.integers["sweeps_a_drift"] = integrator_.sweeps();
        if (integrator_.parts() > 1) c.integers["parts_a_drift"] = integrator_.parts();
        // A branch with a shorter step may owe more than one kick before its first step.
        c.integers["pending_half_kicks"] =
            static_cast<std::int64_t>(std::clamp(2 * integrator_.pending(), 0.0, 2.0));
        c.arrays[array_of_kick] = {integrator_.pending()};
    }
    /// The half kick that ends the last step has the length of that step, not of the branch's.
    void branch(Checkpoint const& c) override {
        double const h = system_.scene().dynamics.step, before = number_in(c, array_of_step, h);
        integrator_.set_pending((pending_in(c) - 0.5) * before / h + 0.5);
        for (AbsoluteDynamics* group : system_.absolute()) group->update_configuration();
    }
    void restore(Checkpoint const& c) override {
        integrator_.set_sweeps(
            counter_of(c, "sweeps_a_drift", 0, ConstrainedIntegrator::most_sweeps));
        if (c.integers.contains("parts_a_drift"))
            integrator_.set_parts(
                counter_of(c, "parts_a_drift", 1, ConstrainedIntegrator::most_parts));
        integrator_.set_pending(pending_in(c));
        for (AbsoluteDynamics* group : system_.absolute()) group->update_configuration();
    }
    json describe() const override {
        json found = {{"matrix_sweeps_a_step", integrator_.matrix_sweeps_a_step()},
                      {"bias_sweeps_a_step", integrator_.bias_sweeps_a_step()},
                      {"sweeps_a_drift", integrator_.sweeps()}};
        if (integrator_.parts() > 1) found["parts_a_drift"] = integrator_.parts();
        if (json const further = closed_.summary(); !further.is_null())
            found["steps_closed_further"] = further;
        return found;
    }

  private:
    /// Returns the part of a kick that is due, in steps.
    static double pending_in(Checkpoint const& c) {
        return number_in(c, array_of_kick, 0.5 * counter_of(c, "pending_half_kicks", 0, 2));
    }
    /// Draws the start velocities of chains with thermal start velocities.
    void draw_velocities(DynamicsSpec const& d) {
        for (AbsoluteDynamics* group : system_.absolute()) {
            std::vector<bool> thermal;
            for (GroupChain const& chain : group->group().chains)
                thermal.push_back(system_.scene().chains[chain.in_scene].velocities ==
                                  StartVelocities::thermal);
            if (std::find(thermal.begin(), thermal.end(), true) == thermal.end()) continue;
            group->assemble_matrices();
            group->draw_velocities(system_.scene().boltzmann() * d.temperature, d.seed, thermal);
        }
    }
    ChainSystem& system_;
    ConstrainedIntegrator integrator_;
    ClosedSteps closed_;
    double offset_ = 0;
};

}  // namespace

double number_in(Checkpoint const& c, char const* array, double otherwise) {
    auto const found = c.arrays.find(array);
    if (found == c.arrays.end() || found->second.empty()) return otherwise;
    if (!std::isfinite(found->second.front()))
        refuse_checkpoint(std::string(array) + " is not finite");
    return found->second.front();
}

bool Stepper::adapt(SweepWatch& watch, double error, double tolerance) {
    if (!watch.is_due(error, early() * tolerance, tolerance) || !add_sweep()) return false;
    watch.added(error);
    return true;
}
json Stepper::inner_steps() const { return nullptr; }

std::unique_ptr<Stepper> make_stepper(ChainSystem& system, DynamicsSpec const& dynamics) {
    if (uses_joint_coordinates(dynamics.integrator))
        return std::make_unique<JointStepper>(system, dynamics);
    return std::make_unique<ConstrainedStepper>(system, dynamics);
}

}  // namespace catena
