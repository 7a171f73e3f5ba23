// Repetition of time steps that left joints open.
#include "integrate/closed_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "dynamics/rigid/rigid_start.hpp"
#include "dynamics/stays_open.hpp"
#include "error.hpp"
#include "integrate/step_failure.hpp"
#include "mpi/first_rank.hpp"

namespace catena {
namespace {

/// If sweeps alone do not close a step's joints, its drifts are split into up to this many times as
/// many parts. Each part has its own matrices.
constexpr int most_times = 64;

}  // namespace

ClosedSteps::ClosedSteps(ChainSystem& system, ConstrainedIntegrator& integrator, double tolerance)
    : system_(system), integrator_(integrator), tolerance_(tolerance) {
    for (AbsoluteDynamics* const group : system.absolute())
        groups_.push_back({&closing_drifts_of(*group), group->group().beads});
}

void ClosedSteps::note(std::int64_t n) {
    if (uses_gpu(system_.backend())) return;
    bool const looks_at_bodies = n < first_steps || n % every_of_bodies == 0;
    for (Group const& group : groups_)
        if (looks_at_bodies || group.beads)
            worst_since_ = larger(worst_since_, group.drifts->own_error_beyond(tolerance_));
}

double ClosedSteps::error() {
    double worst = 0;
    trouble_.clear();
    for (Group const& group : groups_) {
        if (std::string const found = group.drifts->trouble(); trouble_.empty()) trouble_ = found;
        worst = larger(worst, group.drifts->agreed_error());
    }
    system_.check_forces();
    return system_.communicator().max(trouble_.empty() ? worst
                                                       : std::numeric_limits<double>::quiet_NaN());
}

bool ClosedSteps::can_keep(std::int64_t n) const {
    return !uses_gpu(system_.backend()) || n < first_steps;
}

double ClosedSteps::look(std::int64_t n, std::function<void()> const& prepare) {
    double now = error();
    double const worst = larger(system_.communicator().max(worst_since_), now);
    if (!(worst <= tolerance_) && can_repeat(n)) {
        repeat(n, prepare);
        now = error();
    }
    if (std::isnan(now))
        on_every_rank(system_.communicator(), [&] {
            if (!trouble_.empty())
                throw ComputationError(failure_in_step(n, trouble_, system_.scene(), n > 0));
        });
    kept_ = can_keep(n) ? std::optional(Start{n, integrator_.keep()}) : std::nullopt;
    worst_since_ = 0;
    return larger(now, std::exchange(left_open_, 0));
}

bool ClosedSteps::mend(std::int64_t n, std::function<void()> const& prepare) {
    if (!can_repeat(n) || larger(system_.communicator().max(worst_since_), error()) <= tolerance_)
        return false;
    repeat(n, prepare);
    return true;
}

void ClosedSteps::repeat(std::int64_t n, std::function<void()> const& prepare) {
    worst_since_ = 0;
    integrator_.put_back(kept_->state);
    for (std::int64_t m = kept_->step; m <= n; ++m) {
        try {
            // A checkpoint may follow here: ghost lists must be those after a restart from it.
            if (m == n && system_.openmm()) system_.openmm()->renew_ghosts();
            prepare();
            if (m < n) take(m, prepare);
        } catch (SharedError const& error) {
            throw SharedError(failure_in_step(m, error.what(), system_.scene(), true));
        } catch (ClosingFailure const& error) {
            throw SharedError(failure_in_step(m, error.what(), system_.scene(), true));
        } catch (ComputationError const& error) {
            throw ComputationError(failure_in_step(m, error.what(), system_.scene(), true));
        }
    }
}

void ClosedSteps::take(std::int64_t n, std::function<void()> const& prepare) {
    ConstrainedIntegrator::Kept const before = integrator_.keep();
    integrator_.step(n);
    if (error() <= tolerance_) return;
    int const parts = integrator_.parts();
    double const rounding = rounding_at(before);
    for (int times = 1;; times *= 2) {
        integrator_.put_back(before);
        prepare();
        integrator_.set_parts(parts * times);
        try {
            most_sweeps_ = std::max(most_sweeps_,
                                    integrator_.sweeps() + integrator_.step_closing(n, rounding));
            break;
        } catch (ClosingFailure const&) {
            if (times == most_times) throw;
        }
    }
    integrator_.set_parts(parts);
    if (double const open = error(); !(open <= tolerance_)) left_open_ = larger(left_open_, open);
    if (steps_++ == 0) first_ = n;
}

/// Returns the rounding of joints' violations, which are relative to lengths. A violation that
/// converges slowly is far above it.
double ClosedSteps::rounding_at(ConstrainedIntegrator::Kept const& kept) const {
    double constexpr few = 64, most = 1e-7, infinity = std::numeric_limits<double>::infinity();
    Communicator const& communicator = system_.communicator();
    std::vector<AbsoluteDynamics*> const groups = system_.absolute();
    double worst = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        ChainGroup const& group = groups[g]->group();
        double largest = 0, shortest = infinity;
        for (double const x : array_named(kept.state[g], "position").values)
            largest = std::max(largest, std::abs(x));
        bool const links = group.beads || group.linked;  // bodies on joints have no link lengths
        for (std::int64_t k = 0; links && k < group.size; ++k)
            if (double const length = group.joints.length.view().at(k, 0); length > 0)
                shortest = std::min(shortest, length);
        double const length =
            links ? -communicator.max(-shortest) : reach_of_joints(group, communicator);
        largest = communicator.max(largest);
        if (length > 0) worst = std::max(worst, largest / length);
    }
    return std::min(most, few * std::numeric_limits<double>::epsilon() * worst);
}

nlohmann::json ClosedSteps::summary() const {
    if (steps_ == 0) return nullptr;
    return {{"steps", steps_}, {"first", first_}, {"most_sweeps", most_sweeps_}};
}

std::string ClosedSteps::text() const {
    if (steps_ == 0) return "";
    return std::to_string(steps_) + (steps_ == 1 ? " step" : " steps") + " from step " +
           std::to_string(first_) + " on needed up to " + std::to_string(most_sweeps_) +
           " projection sweeps to close the joints";
}

}  // namespace catena
