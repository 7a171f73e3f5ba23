// Whether a run can be believed: what it kept that motion keeps, and how warm it was.
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

/// One question to a run.
struct RunCheck {
    std::string name;    // joints, energy, temperature, coordinates
    bool passed = true;  // false: the run is not valid
    double value = 0, limit = 0;
    std::int64_t step = 0;  // where the value was found
    std::string
        advice;  // a sentence: what was found, and what to do; of one that passed: a note, or empty
};
nlohmann::json as_json(std::vector<RunCheck> const&);
bool all_passed(std::vector<RunCheck> const&);

/// A line's slope by least squares, with the standard error that blocks of its residuals give.
struct Fit {
    double change = 0;  // over the fitted range
    double error = 0;   // of the change, one standard error
    double mean = 0;
};
/// Values at ascending places of about equal distances. Precondition: at least 4.
Fit fit_line(std::vector<double> const& at, std::vector<double> const& values);
/// The standard error of the mean of correlated values: the largest that blocks of 1, 2, 4, ...
/// values give (Flyvbjerg & Petersen, J. Chem. Phys. 91, 461, 1989). Precondition: at least 2.
double standard_error(std::vector<double> const& values);

/// What frames say of a run's energies, in the scene's units.
class EnergyWatch {
  public:
    explicit EnergyWatch(Scene const&);
    /// A frame's; `potential`: where it was found.
    void add(std::int64_t step, double kinetic, std::optional<double> potential) {
        series_.add(step, kinetic, potential);
    }
    /// What a checkpoint keeps of the frames so far, and the same taken back: a restart judges the
    /// whole run. Returns false where no run of so many steps can have kept that.
    std::vector<double> state() const { return series_.state(); }
    bool set_state(std::vector<double> const& state, std::int64_t steps) {
        return series_.set_state(state, steps);
    }
    /// The frames begin at another run's state, which may be far from the thermostat's temperature.
    void begins_midway() { begins_midway_ = true; }
    bool is_midway() const { return begins_midway_; }
    /// Of what conserves its energy: drift over the last three quarters of the frames against
    /// kinetic energy, and a jump before.
    std::optional<RunCheck> energy() const;
    /// Of what a thermostat holds: the second half of the frames. Under gravity, less what
    /// potential energy gave; under torques and wrenches, beyond what these can add at most.
    std::optional<RunCheck> temperature() const;

    /// Nothing puts energy in or takes it out: no thermostat, damper, drag, drive or load from
    /// outside.
    static bool conserves_energy(Scene const&);

  private:
    /// The second half of the frames. Energies are divided by the thermostat's kinetic energy.
    struct Warmth {
        std::vector<double> ratio;       // kinetic energy of each entry
        double mean = 0, error = 0;      // of the ratios; one standard error
        double released = 0, added = 0;  // kinetic energy that a fall of potential energy and work
                                         // keep up; the second at most
        double lasted = 0;               // time
        std::int64_t from = 0;           // step
        bool forgotten = false;          // the start is
    };
    /// Of gravity as well where frames do not tell its energy.
    Heating const& heating() const;
    Warmth warmth() const;
    std::string found(Warmth const&) const;
    void judge(Warmth const&, RunCheck&) const;
    std::string span(double from, double to) const;
    Scene const& scene_;
    double freedom_;  // degrees
    Heating heating_, heating_by_gravity_too_;
    EnergySeries series_;
    bool begins_midway_ = false;
};

/// Joints: the largest error and where it was.
RunCheck joints_verdict(double largest, double tolerance, std::int64_t step,
                        std::string const& of_step);
/// 0: there is none.
double shortest_link(Scene const&);
/// Whether coordinates as large as `largest` resolve joints to the tolerance; `length`: of the
/// shortest link, 0: there is none.
std::optional<RunCheck> coordinates_verdict(double largest, double length, double tolerance,
                                            std::int64_t step);

}  // namespace catena
