// Verdict on a run: conservation of energy, temperature, joint errors and range of coordinates.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "observe/energy_series.hpp"
#include "observe/heating.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Result of one check of a run.
struct RunCheck {
    std::string name;    // joints, energy, temperature, coordinates
    bool passed = true;  // false: the run is invalid
    double value = 0, limit = 0;
    std::int64_t step = 0;  // step where the value occurred
    std::string advice;  // sentence with finding and remedy; after a passed check a note, or empty
};
/// Returns {"valid", "checks": [{"name", "passed", "value", "limit", "step", "advice"}]}.
nlohmann::json as_json(std::vector<RunCheck> const&);
bool all_passed(std::vector<RunCheck> const&);

/// Line fitted by least squares. The standard error of its slope follows from blocking of the
/// residuals.
struct Fit {
    double change = 0;  // change over the fitted range
    double error = 0;   // standard error of the change
    double mean = 0;
};
/// Fits values at ascending positions of about equal distances. Precondition: at least 4 values.
Fit fit_line(std::vector<double> const& at, std::vector<double> const& values);
/// Standard error of the mean of correlated values: the largest that blocks of 1, 2, 4, ... values
/// yield (Flyvbjerg & Petersen, J. Chem. Phys. 91, 461, 1989). Precondition: at least 2 values.
double standard_error(std::vector<double> const& values);

/// Checks of a run's energies, in the scene's units.
class EnergyWatch {
  public:
    explicit EnergyWatch(Scene const&);
    /// Adds a frame. `potential`: empty if it was not computed.
    void add(std::int64_t step, double kinetic, std::optional<double> potential) {
        series_.add(step, kinetic, potential);
    }
    /// Returns, or restores, what a checkpoint keeps of the frames so far, so that a restart judges
    /// the whole run. set_state() returns false if no run of `steps` steps can have kept that.
    std::vector<double> state() const { return series_.state(); }
    bool set_state(std::vector<double> const& state, std::int64_t steps) {
        return series_.set_state(state, steps);
    }
    /// States that the frames begin at another run's state, which may be far from the thermostat's
    /// temperature.
    void begins_midway() { begins_midway_ = true; }
    bool is_midway() const { return begins_midway_; }
    /// Checks a scene that conserves its energy: drift over the last three quarters of the frames
    /// relative to kinetic energy, and a jump before. In all scenes an energy that is not finite
    /// fails. Empty if the check does not apply.
    std::optional<RunCheck> energy() const;
    /// Checks the temperature under a thermostat over the second half of the frames. Kinetic energy
    /// released by potential energy is subtracted under gravity. Torques and wrenches raise the
    /// limit by the heating that they can cause at most. Empty if the check does not apply.
    std::optional<RunCheck> temperature() const;

    /// True if nothing adds or removes energy: no thermostat, damper, drag, prescribed motion or
    /// external load.
    static bool conserves_energy(Scene const&);

  private:
    /// Failed check of an energy that is not finite; empty if all are.
    std::optional<RunCheck> lost_energy() const;
    /// Kinetic energy over the second half of the frames, divided by the thermostat's.
    struct Warmth {
        std::vector<double> ratio;       // per entry of the series
        double mean = 0, error = 0;      // ratios: mean and its standard error
        double released = 0, added = 0;  // kinetic energy kept up by released potential energy, and
                                         // by work (upper bound)
        double lasted = 0;               // duration of the window
        std::int64_t from = 0;           // first step of the window
        bool forgotten = false;          // the start no longer matters
    };
    /// Returns the heating by loads, which includes gravity if frames do not contain its energy.
    Heating const& heating() const;
    Warmth warmth() const;
    /// Sentence with the temperature found and the thermostat's.
    std::string found(Warmth const&) const;
    /// Checks the temperature of an equilibrated run.
    void judge(Warmth const&, RunCheck&) const;
    /// Text of two energies with their unit.
    std::string span(double from, double to) const;
    Scene const& scene_;
    double freedom_;  // degrees of freedom
    Heating heating_, heating_by_gravity_too_;
    EnergySeries series_;
    bool begins_midway_ = false;
};

/// Checks joints by their largest constraint error, which occurred at `step`. `of_step`: key of the
/// step length, for the advice.
RunCheck joints_verdict(double largest, double tolerance, std::int64_t step,
                        std::string const& of_step);
/// Returns the length of the shortest link, or 0 if there are no links.
double shortest_link(Scene const&);
/// Checks whether coordinates as large as `largest` resolve joints to the tolerance, given their
/// rounding. `length`: length of the shortest link; 0: no links, no check.
std::optional<RunCheck> coordinates_verdict(double largest, double length, double tolerance,
                                            std::int64_t step);

}  // namespace catena
