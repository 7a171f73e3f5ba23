// Work-precision of the integrators: how far a scene's bodies are from where they belong after a
// fixed time, and how well energy is kept, over the step or the tolerance; and whether energy
// drifts over many steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

struct IntegratorPoint {
    double step = 0;   // adaptive: at whose multiples the run stops over
    double error = 0;  // largest difference of a centre of mass (bead) at the end, over the scene's
                       // extent there
    std::optional<double>
        energy_error;  // largest |E - E(0)| at the samples, over the largest kinetic energy there
    Spread seconds;    // of the whole time
    std::string no_error;  // why there is none to speak of: "unstable", "came to no end"; empty:
                           // there is one
    // Of an adaptive run.
    double tolerance = 0;
    std::int64_t taken = 0, rejected = 0;  // inner steps
    double allowed = 0;                    // error; see study_integrator_errors()
};
enum class Scheme { explicit_steps, implicit_springs, adaptive };
struct IntegratorCurve {
    std::string name;
    int order = 0;  // nominal; 0: adaptive
    std::vector<IntegratorPoint> points;
    /// Of the two finest steps whose errors stand well above the reference's own and rounding;
    /// nothing where there are none.
    std::optional<double> slope;
    bool exact =
        false;  // all errors are roundings, and so is the reference's: there is no order to see
    Scheme scheme = Scheme::explicit_steps;
    /// Of an implicit one: of a line through errors below a hundredth at all steps at which its
    /// explicit counterpart has no error to speak of.
    std::optional<double> slope_beyond;
    bool slow = false;       // and that is to be the order, too
    bool too_stiff = false;  // springs leave an explicit one fewer than two of the steps

    bool as_promised() const;
    /// The shortest step without an error to speak of; 0: all have one.
    double unstable_from() const;
};
struct IntegratorStudy {
    std::string title, reference;
    std::int64_t bodies = 0;
    double time = 0;
    double reference_error = 0;   // how far the reference is from itself at twice its step
    std::string no_energy_error;  // why the energy's change is no error; empty: it is one
    std::string no_implicit;  // why joints have springs and no integrator takes them implicitly;
                              // empty: none has, or some do
    int refine = 0;           // solver.refine, of those integrators whose solutions are refined
    std::vector<IntegratorCurve> curves;
    bool valid() const;
    bool has_implicit() const;
};

/// Empty where the study can be made; else why not: OpenMM, a thermal start, dampers, drag, driven
/// joints, or no integrator for all chains.
std::string why_integrators_cannot_be_compared(Scene const&);

/// Every deterministic integrator of second or fourth order that the scene's chains have, g-baoab
/// at zero friction included, over `time`: steps of time / 2^k, finest for those of second order
/// `finest`. Where joints have springs also those that take them implicitly, and steps down to a
/// quarter of that, for the explicit ones to be stable at some.
///
/// dormand-prince over tolerances: its error is allowed to be the tolerance times the inner steps,
/// each of which may add that much.
///
/// `slow`: springs hardly vibrate in this scene, so that implicit integrators are of second order
/// wherever steps resolve the slow motion.
///
/// The reference is dormand-prince in equal steps where the chains have it, else rattle, at far
/// smaller ones.
IntegratorStudy study_integrator_errors(Scene const&, Communicator const&, double time, int finest,
                                        int repeat, bool slow = false);

/// Of a scene whose energy is kept. The energy's trend over many steps: the slope of a straight
/// line through means over blocks of them, and its standard error.
struct DriftStudy {
    std::string title, name;
    double step = 0;
    std::int64_t steps = 0;
    double kinetic_energy = 0;          // mean
    double scatter = 0;                 // standard deviation of the energy about its mean
    double slope = 0, slope_error = 0;  // per unit of time
    bool valid() const {
        return slope * slope <= 16 * slope_error * slope_error;
    }  // four standard errors
};
DriftStudy study_drift(Scene const&, Communicator const&, Integrator, double step,
                       std::int64_t steps);

}  // namespace catena
