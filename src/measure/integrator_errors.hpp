// Work-precision studies of the integrators. One compares positions after a fixed time and energy
// conservation for different steps or tolerances. The other looks for a drift of energy over many
// steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

/// One integrator with one step or tolerance.
struct IntegratorPoint {
    double step = 0;  // time step; adaptive: interval at whose multiples inner steps end
    /// Largest difference of a centre of mass (bead) at the end, divided by the scene's extent
    /// there.
    double error = 0;
    /// Largest |E - E(0)| of the samples, divided by the largest kinetic energy of the run.
    std::optional<double> energy_error;
    Spread seconds;  // time of the run, s
    /// Reason why no error could be computed: "unstable" or "did not finish"; empty if one could.
    std::string no_error;
    // Members of adaptive runs.
    double tolerance = 0;
    std::int64_t taken = 0, rejected = 0;  // inner steps
    /// Largest error allowed; see study_integrator_errors().
    double allowed = 0;
};
/// Kind of an integrator's time steps.
enum class Scheme { explicit_steps, implicit_springs, adaptive };
/// Error over step (or tolerance) of one integrator.
struct IntegratorCurve {
    std::string name;
    int order = 0;  // nominal order; 0: adaptive
    std::vector<IntegratorPoint> points;
    /// Order found from the two finest steps whose errors are well above rounding and the
    /// reference's own error. Absent if there are no such steps.
    std::optional<double> slope;
    /// True if all errors are rounding, and so is the reference's: no order can be found.
    bool exact = false;
    Scheme scheme = Scheme::explicit_steps;
    /// Order of an implicit integrator at large steps: the slope of a line through errors below a
    /// hundredth, at all steps at which its explicit counterpart is unstable.
    std::optional<double> slope_beyond;
    /// True if slope_beyond must be the nominal order, too.
    bool slow = false;
    /// True if springs leave an explicit integrator fewer than two stable steps.
    bool too_stiff = false;

    /// True if the order, or each error of an adaptive integrator, is as promised.
    bool as_promised() const;
    /// Returns the shortest step at which the integrator was unstable or failed; 0 if there is
    /// none.
    double unstable_from() const;
};
/// Result of study_integrator_errors().
struct IntegratorStudy {
    std::string title, reference;
    std::int64_t bodies = 0;
    // length of the run
    double time = 0;
    /// Difference between the reference and itself at twice its step.
    double reference_error = 0;
    /// Reason why the energy's change is no error; empty if it is one.
    std::string no_energy_error;
    /// Reason why no integrator treats existing springs implicitly; empty if there are no springs
    /// or some integrator does.
    std::string no_implicit;
    /// solver.refine of the integrators whose solutions are refined.
    int refine = 0;
    std::vector<IntegratorCurve> curves;
    /// True if all curves are as promised and all errors are finite.
    bool valid() const;
    /// True if the study has an implicit integrator.
    bool has_implicit() const;
};

/// Returns why the study cannot be made; empty if it can. Reasons are OpenMM, a thermal start,
/// dampers, drag, driven joints, or no integrator for all chains.
std::string why_integrators_cannot_be_compared(Scene const&);

/// Compares every deterministic integrator of second or fourth order that supports the scene's
/// chains, including g-baoab at zero friction.
/// `time`: length of the run. Steps are time / 2^k; `finest` is the largest k for second order. If
/// joints have springs, integrators that treat them implicitly are included. Steps are then refined
/// by another factor of four, so that explicit integrators are stable at some of them.
///
/// dormand-prince is run with several tolerances. Its error may be the tolerance times the number
/// of inner steps, because each may contribute that much.
///
/// `slow`: true if springs hardly vibrate in this scene. Implicit integrators must then have second
/// order at all steps that resolve the slow motion.
///
/// The reference is dormand-prince in equal steps if it supports the chains, else rattle, with far
/// smaller steps. `repeat`: timed runs per point. Collective.
IntegratorStudy study_integrator_errors(Scene const&, Communicator const&, double time, int finest,
                                        int repeat, bool slow = false);

/// Drift of energy of a scene that conserves it: the slope of a straight line through block means
/// of the energy, and the slope's standard error.
struct DriftStudy {
    std::string title, name;
    double step = 0;
    std::int64_t steps = 0;
    double kinetic_energy = 0;          // mean
    double scatter = 0;                 // standard deviation of the energy about its mean
    double slope = 0, slope_error = 0;  // per unit of time
    /// True if the slope is within four standard errors of zero.
    bool valid() const { return slope * slope <= 16 * slope_error * slope_error; }
};
/// Runs the scene for `steps` time steps and fits the drift. Collective.
DriftStudy study_drift(Scene const&, Communicator const&, Integrator, double step,
                       std::int64_t steps);

}  // namespace catena
