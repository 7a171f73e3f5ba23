#include "integrate/constrained_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "error.hpp"

namespace catena {

ConstrainedIntegrator::ConstrainedIntegrator(ConstrainedScheme const& scheme, std::vector<AbsoluteDynamics*> const& groups)
    : scheme_(scheme), groups_(groups) {}

void ConstrainedIntegrator::step(std::int64_t n) {
    double const h = scheme_.step;
    ConstrainedStep step;
    step.langevin = is_langevin(scheme_.kind);
    step.kick = pending_ * h;
    step.drift = h;
    step.sweeps = sweeps_;
    step.parts = parts_;
    step.thermostat = thermostat_of(std::exp(-scheme_.friction * h), scheme_.kt, scheme_.seed);
    step.number = static_cast<std::uint64_t>(n);
    for (AbsoluteDynamics* group : groups_) group->step(step);
    pending_ = 1.0;
}

void ConstrainedIntegrator::observe() {
    for (AbsoluteDynamics* group : groups_) group->observe((pending_ - 0.5) * scheme_.step);
}

double ConstrainedIntegrator::error_after(int sweeps) {
    double const h = scheme_.step / drifts();
    double worst = 0;
    for (AbsoluteDynamics* group : groups_) {
        std::vector<StateArray> const before = group->state();
        // Steps with implicit joints are long for what may start at rest.
        if (is_implicit(scheme_.kind))
            group->draw_velocities(scheme_.kt, scheme_.seed, std::vector<bool>(group->group().chain.size(), true));
        group->kick(pending_ * scheme_.step);
        group->drift(h, sweeps);
        double const error = group->constraint_error();
        group->set_state(before);
        group->update_configuration();
        worst = larger(worst, error);
    }
    return worst;
}

/// Where so many suffice.
bool ConstrainedIntegrator::choose_sweeps(int most) {
    double before = std::numeric_limits<double>::infinity();
    for (int sweeps = 1; sweeps <= most; ++sweeps) {
        double const error = error_after(sweeps);
        bool const at_rounding = error <= scheme_.tolerance && error > 0.5 * before;
        if (error <= 0.01 * scheme_.tolerance || at_rounding) {
            sweeps_ = std::min(sweeps + 1, most_sweeps);
            return true;
        }
        before = error;
    }
    last_error_ = before;
    return false;
}

void ConstrainedIntegrator::choose_sweeps() {
    if (is_implicit(scheme_.kind)) {
        // A sweep that gains two digits has room for joints that turn more than those of the trial.
        int constexpr few = 8, most_parts = 64;
        for (parts_ = 1; parts_ <= most_parts; parts_ *= 2)
            if (choose_sweeps(few)) return;
        parts_ = most_parts;
    }
    if (choose_sweeps(most_sweeps)) return;
    std::ostringstream line;
    line << "the joints do not close to dynamics.constraint_tolerance = " << scheme_.tolerance << " within " << most_sweeps
         << " sweeps of a step of " << scheme_.step << " (error " << last_error_
         << "): " << (last_error_ < 1e-13 ? "that is rounding, ask for no less than 1e-12" : "choose a smaller dynamics.step");
    throw ComputationError(line.str());
}

}  // namespace catena
