// RATTLE and g-BAOAB, and the choice of their numbers of sweeps and parts.
#include "integrate/constrained_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "dynamics/closing.hpp"
#include "error.hpp"

namespace catena {
namespace {

/// Operations of a time step (take_step()) whose drifts get further sweeps until joints close.
struct ClosingParts {
    AbsoluteDynamics& dynamics;
    ClosingDrifts& drifts;
    Closing closing;
    int most = 0;
    void update_configuration() { dynamics.update_configuration(); }
    void assemble_matrices() { dynamics.assemble_matrices(); }
    void thermalise(Thermostat const& thermostat, std::uint64_t step) {
        dynamics.thermalise(thermostat, step);
    }
    void kick(double h) { dynamics.kick(h); }
    void drift(double h, int sweeps) {
        most = std::max(most, drifts.drift_closing(h, sweeps, closing));
    }
};

}  // namespace

ClosingDrifts& closing_drifts_of(AbsoluteDynamics& group) {
    return dynamic_cast<ClosingDrifts&>(group);
}

ConstrainedIntegrator::ConstrainedIntegrator(ConstrainedScheme const& scheme,
                                             std::vector<AbsoluteDynamics*> const& groups)
    : scheme_(scheme), groups_(groups) {}

ConstrainedStep ConstrainedIntegrator::step_of(std::int64_t n) const {
    double const h = scheme_.step;
    ConstrainedStep step;
    step.langevin = is_langevin(scheme_.kind);
    step.kick = pending_ * h;
    step.drift = h;
    step.sweeps = sweeps_;
    step.parts = parts_;
    step.thermostat = thermostat_of(std::exp(-scheme_.friction * h), scheme_.kt, scheme_.seed);
    step.number = static_cast<std::uint64_t>(n);
    return step;
}

void ConstrainedIntegrator::step(std::int64_t n) {
    ConstrainedStep const step = step_of(n);
    for (AbsoluteDynamics* group : groups_) group->step(step);
    pending_ = 1.0;
}

int ConstrainedIntegrator::step_closing(std::int64_t n, double rounding) {
    ConstrainedStep const step = step_of(n);
    Closing const closing{scheme_.tolerance, early * scheme_.tolerance, most_sweeps, rounding};
    int most = 0;
    for (AbsoluteDynamics* group : groups_) {
        ClosingParts parts{*group, closing_drifts_of(*group), closing};
        take_step(parts, step);
        most = std::max(most, parts.most);
    }
    pending_ = 1.0;
    return most;
}

ConstrainedIntegrator::Kept ConstrainedIntegrator::keep() const {
    Kept kept{{}, pending_};
    for (AbsoluteDynamics* group : groups_) kept.state.push_back(group->state());
    return kept;
}

void ConstrainedIntegrator::put_back(Kept const& kept) {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        groups_[g]->set_state(kept.state[g]);
        groups_[g]->update_configuration();
    }
    pending_ = kept.pending;
}

void ConstrainedIntegrator::observe() {
    for (AbsoluteDynamics* group : groups_) group->observe((pending_ - 0.5) * scheme_.step);
}

/// Does the first drift of a step, from the present velocities or from thermal ones.
void ConstrainedIntegrator::begin_trial(AbsoluteDynamics& group, int sweeps, bool thermal) const {
    if (thermal)
        group.draw_velocities(scheme_.kt, scheme_.seed,
                              std::vector<bool>(group.group().chains.size(), true));
    group.kick(pending_ * scheme_.step);
    group.drift(scheme_.step / drifts(), sweeps);
}

bool ConstrainedIntegrator::choose_sweeps(int most, bool thermal) {
    std::vector<std::vector<StateArray>> before;
    for (AbsoluteDynamics* group : groups_) before.push_back(group->state());
    auto const put_back = [&](std::size_t g) {
        groups_[g]->set_state(before[g]);
        groups_[g]->update_configuration();
    };
    auto const error_after = [&](int sweeps) {
        double worst = 0;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            if (sweeps == 1)
                begin_trial(*groups_[g], sweeps, thermal);
            else if (!groups_[g]->close_further(scheme_.step / drifts())) {
                put_back(g);
                begin_trial(*groups_[g], sweeps, thermal);
            }
            worst = larger(worst, groups_[g]->constraint_error());
        }
        return worst;
    };
    double error = std::numeric_limits<double>::infinity();
    int sweeps = 0;
    bool enough = false;
    while (!enough && sweeps < most) {
        double const last = std::exchange(error, error_after(++sweeps));
        bool const at_rounding = error <= scheme_.tolerance && error > 0.5 * last;
        enough = error <= early * scheme_.tolerance || at_rounding;
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) put_back(g);
    if (enough) sweeps_ = sweeps;
    last_error_ = error;
    return enough;
}

void ConstrainedIntegrator::choose_sweeps() {
    if (is_implicit(scheme_.kind)) {
        // A sweep that gains two digits leaves a margin for joints that rotate faster than those of
        // the trial.
        int constexpr few = 8;
        for (parts_ = 1; parts_ <= most_parts; parts_ *= 2)
            if (choose_sweeps(few, true)) return;
        parts_ = most_parts;
    }
    int const of_now = choose_sweeps(most_sweeps, false) ? sweeps_ : 0;
    if (of_now > 0 && (!is_langevin(scheme_.kind) || choose_sweeps(most_sweeps, true))) {
        sweeps_ = std::max(sweeps_, of_now);
        return;
    }
    std::ostringstream line;
    line << "the joints do not close to " << early * scheme_.tolerance
         << ", a hundredth of dynamics.constraint_tolerance, within " << most_sweeps
         << " sweeps of a step of " << scheme_.step << " (" << closing_error(last_error_) << "): "
         << (last_error_ < 1e-13 ? "this is rounding error, use a tolerance of 1e-12 or more"
                                 : "choose a smaller dynamics.step");
    throw ComputationError(line.str());
}

}  // namespace catena
