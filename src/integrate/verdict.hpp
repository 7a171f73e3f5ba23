// Whether a run can be believed: what it kept that motion keeps, and how warm it was.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

/// One question to a run.
struct RunCheck {
    std::string name;    // joints, energy, temperature, coordinates
    bool passed = true;  // false: the run is not valid
    double value = 0, limit = 0;
    std::int64_t step = 0;  // where the value was found
    std::string advice;     // a sentence: what was found, and what to do; of one that passed: a note, or empty
};
nlohmann::json as_json(std::vector<RunCheck> const&);
bool all_passed(std::vector<RunCheck> const&);

/// A line's slope by least squares, with the standard error that blocks of its residuals give.
struct Fit {
    double change = 0;  // over the fitted range
    double error = 0;   // of the change, one standard error
    double mean = 0;
};
/// Values at equal distances. Precondition: at least 4.
Fit fit_line(std::vector<double> const& values);
/// The standard error of the mean of correlated values: the largest that blocks of 1, 2, 4, ... values give (Flyvbjerg & Petersen, J. Chem.
/// Phys. 91, 461, 1989). Precondition: at least 2.
double standard_error(std::vector<double> const& values);

/// What frames say of a run's energies, in the scene's units.
class EnergyWatch {
  public:
    explicit EnergyWatch(Scene const&);
    /// A frame's; `potential`: where it was found.
    void add(std::int64_t step, double kinetic, std::optional<double> potential);
    /// Of what conserves its energy: drift over the last three quarters of the frames against kinetic energy, and a jump before.
    std::optional<RunCheck> energy() const;
    /// Of what a thermostat holds: the second half of the frames.
    std::optional<RunCheck> temperature() const;

    /// Nothing puts energy in or takes it out: no thermostat, damper, drag, drive or load from outside.
    static bool conserves_energy(Scene const&);

  private:
    std::string span(double from, double to) const;
    Scene const& scene_;
    double freedom_;  // degrees
    std::vector<std::int64_t> step_;
    std::vector<double> kinetic_, total_;  // total_: empty from where a frame has no potential energy
    bool has_potential_ = true;
};

/// Joints: the largest error and where it was.
RunCheck joints_verdict(double largest, double tolerance, std::int64_t step, std::string const& of_step);
/// 0: there is none.
double shortest_link(Scene const&);
/// Whether coordinates as large as `largest` resolve joints to the tolerance; `length`: of the shortest link, 0: there is none.
std::optional<RunCheck> coordinates_verdict(double largest, double length, double tolerance, std::int64_t step);

}  // namespace catena
