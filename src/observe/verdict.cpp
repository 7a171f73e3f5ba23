// Implements the checks of a run.
#include "observe/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "observe/observables.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

/// Limits relative to the kinetic energy: a drift that invalidates the run, a drift that is
/// reported, and a jump that is reported.
constexpr double worthless_drift = 0.1, said_drift = 0.01, said_jump = 0.05;
/// Largest ratio to the thermostat's kinetic energy. No start that is still cooling explains more
/// over the second half of a run.
constexpr double worthless_heat = 3;
/// Limits for an equilibrated run: a deviation that is reported, and heat that invalidates the run.
constexpr double said_heat = 0.03, worthless_heat_in_equilibrium = 0.5;
constexpr double standard_errors = 5;  // significance of a deviation
/// Number of friction times after which a start is forgotten, and number of frames for a meaningful
/// standard error.
constexpr double forgotten_after = 5;
constexpr std::size_t enough_frames = 8;

char const* const causes_of_heat =
    ": the step is too long or the start overlaps: choose a smaller dynamics.step, or look at the "
    "start";

double mean_of(std::vector<double> const& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

bool any(std::vector<Vec3> const& values) {
    return std::any_of(values.begin(), values.end(), [](Vec3 const& v) { return norm(v) > 0; });
}

/// True if no force term or prescribed motion changes the energy of a chain.
bool conserves_energy_of(Scene const& scene, ChainSpec const& chain) {
    return chain.bodies.driven.empty() && !terms::any_of([&](auto term) {
               return term.does_work && decltype(term)::count(scene, chain) > 0;
           });
}

/// True if kinetic energy measures the thermostat's temperature. Bodies in SI units that start at
/// given velocities move far beyond thermal motion.
bool is_thermal(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    if (!is_langevin(d.integrator) || d.temperature <= 0 || d.friction <= 0) return false;
    auto const any_chain = [&](auto const& is) {
        return std::any_of(scene.chains.begin(), scene.chains.end(), is);
    };
    return !scene.si || any_chain([](ChainSpec const& chain) {
        return chain.velocities == StartVelocities::thermal;
    });
}

/// True if some chain starts at velocities, given by the scene, that are not zero.
bool starts_at_given_velocities(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
        return chain.velocities == StartVelocities::given &&
               (any(chain.beads.velocity) || any(chain.bodies.qd) || any(chain.linked.velocity) ||
                any(chain.linked.omega) || norm(chain.bodies.free_base.velocity) > 0);
    });
}

}  // namespace

nlohmann::json as_json(std::vector<RunCheck> const& verdicts) {
    nlohmann::json checks = nlohmann::json::array();
    for (RunCheck const& v : verdicts)
        checks.push_back({{"name", v.name},
                          {"passed", v.passed},
                          {"value", v.value},
                          {"limit", v.limit},
                          {"step", v.step},
                          {"advice", v.advice}});
    return {{"valid", all_passed(verdicts)}, {"checks", checks}};
}

bool all_passed(std::vector<RunCheck> const& verdicts) {
    return std::all_of(verdicts.begin(), verdicts.end(),
                       [](RunCheck const& v) { return v.passed; });
}

double standard_error(std::vector<double> const& values) {
    double worst = 0;
    std::vector<double> blocks = values;
    while (blocks.size() >= 2) {
        double const mean = mean_of(blocks), n = static_cast<double>(blocks.size());
        double square = 0;
        for (double const value : blocks) square += (value - mean) * (value - mean);
        worst = std::max(worst, std::sqrt(square / (n * (n - 1))));
        if (blocks.size() < 8) break;
        for (std::size_t i = 0; i + 1 < blocks.size(); i += 2)
            blocks[i / 2] = 0.5 * (blocks[i] + blocks[i + 1]);
        blocks.resize(blocks.size() / 2);
    }
    return worst;
}

Fit fit_line(std::vector<double> const& at, std::vector<double> const& values) {
    double const middle = mean_of(at), mean = mean_of(values), length = at.back() - at.front();
    double along = 0, across = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        along += (at[i] - middle) * (at[i] - middle);
        across += (at[i] - middle) * (values[i] - mean);
    }
    double const slope = across / along;
    std::vector<double> residual;
    for (std::size_t i = 0; i < values.size(); ++i)
        residual.push_back(values[i] - mean - slope * (at[i] - middle));
    // Correlated residuals count as fewer independent ones, as blocking shows. The slope's error
    // over that of a mean is 12^(1/2) / n.
    return {slope * length, std::sqrt(12.0) * standard_error(residual), mean};
}

bool EnergyWatch::conserves_energy(Scene const& scene) {
    if (is_langevin(scene.dynamics.integrator) || is_implicit(scene.dynamics.integrator))
        return false;
    return std::all_of(scene.chains.begin(), scene.chains.end(),
                       [&](ChainSpec const& chain) { return conserves_energy_of(scene, chain); });
}

EnergyWatch::EnergyWatch(Scene const& scene)
    : scene_(scene),
      freedom_(static_cast<double>(degrees_of_freedom(scene))),
      heating_(is_thermal(scene) ? heating_of(scene, false) : Heating()),
      heating_by_gravity_too_(is_thermal(scene) ? heating_of(scene, true) : Heating()) {}

Heating const& EnergyWatch::heating() const {
    return series_.has_potential() ? heating_ : heating_by_gravity_too_;
}

std::string EnergyWatch::span(double from, double to) const {
    return fmt::format("{:.5g} to {:.5g} {}", from, to, scene_.si ? "J" : "kJ/mol");
}

std::optional<RunCheck> EnergyWatch::lost_energy() const {
    for (std::size_t i = 0; series_.has_potential() && i < series_.size(); ++i) {
        if (std::isfinite(series_.total(i))) continue;
        std::int64_t const step = series_.first_step(i);
        return RunCheck{
            "energy",
            false,
            series_.total(i),
            worthless_drift,
            step,
            fmt::format("the energy is not a finite number at step {}: a force is beyond its "
                        "range, such as a torn FENE bond: look at the start, or choose a smaller "
                        "dynamics.step",
                        step)};
    }
    return std::nullopt;
}

std::optional<RunCheck> EnergyWatch::energy() const {
    if (auto const lost = lost_energy()) return lost;
    std::size_t const n = series_.size(), from = std::max<std::size_t>(1, n / 4);
    if (!conserves_energy(scene_) || !series_.has_potential() || n < 2) return std::nullopt;
    std::vector<double> at, later;
    for (std::size_t i = from; i < n; ++i)
        // A line needs four entries; fewer are fitted by the difference of last and first.
        at.push_back(series_.middle(i)), later.push_back(series_.total(i));
    Fit fit{later.back() - later.front(), 0, mean_of(later)};
    if (later.size() >= 4) fit = fit_line(at, later);
    double const scale = std::max(series_.largest_kinetic(), 1e-6 * series_.largest_total());
    std::int64_t const from_step = series_.first_step(from), last = series_.last_step();
    RunCheck v{"energy", true, 0, worthless_drift, last, ""};
    if (scale == 0) return v;
    v.value = fit.change / scale;
    double const noise = standard_errors * fit.error / scale,
                 jump = (later.front() - series_.first_total()) / scale;
    bool const drifts = std::abs(v.value) > noise;
    std::string const found = fmt::format(
        "total energy, which should be constant, drifted from {} between steps {} and {}, by "
        "{:.3g} +- {:.2g} of the kinetic energy",
        span(fit.mean - 0.5 * fit.change, fit.mean + 0.5 * fit.change), from_step, last, v.value,
        fit.error / scale);
    if (!std::isfinite(v.value) || (drifts && std::abs(v.value) > worthless_drift)) {
        v.passed = false;
        v.advice = found + ": the step is too long: choose a smaller dynamics.step";
    } else if (drifts && std::abs(v.value) > said_drift) {
        v.advice = found + ": a smaller dynamics.step conserves it better";
    } else if (std::abs(jump) > said_jump) {
        v.advice = fmt::format(
            "total energy, which should be constant, jumped from {} between steps {} and {} and "
            "stayed there: the step is too "
            "long for the start: choose a smaller dynamics.step",
            span(series_.first_total(), later.front()), series_.first_step(0), from_step);
    }
    return v;
}

EnergyWatch::Warmth EnergyWatch::warmth() const {
    DynamicsSpec const& d = scene_.dynamics;
    std::size_t const n = series_.size(), from = std::max<std::size_t>(1, n / 2);
    double const thermal = 0.5 * scene_.boltzmann() * freedom_ * d.temperature;
    Warmth w;
    for (std::size_t i = from; i < n; ++i) w.ratio.push_back(series_.kinetic(i) / thermal);
    w.mean = mean_of(w.ratio);
    w.from = series_.first_step(from);
    w.lasted = static_cast<double>(series_.last_step() - w.from) * d.step;
    w.forgotten = static_cast<double>(w.from - series_.first_step(0)) * d.step * d.friction >=
                  forgotten_after;
    // Friction makes frames independent after a friction time.
    double const independent =
        std::min(static_cast<double>(w.ratio.size()), std::max(1.0, w.lasted * d.friction));
    double const own = w.ratio.size() < 2 ? 0 : standard_error(w.ratio);
    w.error = std::max(own, std::sqrt(2 / freedom_) / std::sqrt(independent));
    if (!heating().is_pushed || w.lasted <= 0) return w;
    w.added = heating().excess / d.temperature;
    // Friction removed the energy that the window lost, so that the kinetic energy exceeded the
    // thermostat's accordingly.
    double const time = (series_.middle(n - 1) - series_.middle(from)) * d.step;
    if (!series_.has_potential()) return w;
    w.error = std::hypot(w.error, 2 * std::sqrt(2 / freedom_) / (d.friction * time));
    w.released = drift_of_step(d) * (series_.total(from) - series_.total(n - 1)) /
                 (2 * d.friction * time * thermal);
    return w;
}

std::string EnergyWatch::found(Warmth const& w) const {
    return fmt::format("temperature {:.4g} K over steps {} to {}, the thermostat's is {:.4g} K",
                       w.mean * scene_.dynamics.temperature, w.from, series_.last_step(),
                       scene_.dynamics.temperature);
}

std::optional<RunCheck> EnergyWatch::temperature() const {
    if (!is_thermal(scene_) || freedom_ <= 0 || series_.size() < 2) return std::nullopt;
    Warmth const w = warmth();
    double const of_thermostat = scene_.dynamics.temperature, canonical = std::sqrt(2 / freedom_);
    // Weak friction makes the energy released by potential energy uncertain.
    double const error = heating().is_pushed ? std::max(canonical, w.error) : canonical;
    double const most =
        worthless_heat * (1 + standard_errors * error + std::max(0.0, w.released) + w.added);
    RunCheck v{"temperature",       true, w.mean * of_thermostat, most * of_thermostat,
               series_.last_step(), ""};
    if (heating().is_pushed && !heating().unknown.empty()) {
        v.advice = "temperature is not checked: " + heating().unknown;
        return v;
    }
    if (heating().is_pushed && w.ratio.size() < enough_frames) return std::nullopt;
    if (!(v.value <= v.limit)) {
        // Velocities given by the scene may be far from thermal until friction has removed them.
        v.passed = std::isfinite(v.value) && !w.forgotten &&
                   (begins_midway_ || starts_at_given_velocities(scene_));
        v.advice = found(w) +
                   (v.passed ? ": the start velocities still matter: run longer" : causes_of_heat);
        return v;
    }
    // Frames do not contain the kinetic energy of the rotors of implicit springs. Only the upper
    // limit is checked there.
    if (w.ratio.size() >= enough_frames && w.forgotten && !is_implicit(scene_.dynamics.integrator))
        judge(w, v);
    return v;
}

void EnergyWatch::judge(Warmth const& w, RunCheck& v) const {
    double const cold = 1 + w.released, warm = cold + w.added,
                 away = std::max(cold - w.mean, w.mean - warm);
    if (away > said_heat * std::max(1.0, warm) && away > standard_errors * w.error) {
        v.passed = w.mean < warm + worthless_heat_in_equilibrium * std::max(1.0, warm);
        v.advice = fmt::format("{} ({:.0f} standard errors away)", found(w), away / w.error);
        v.advice += v.passed ? ": the step is long for these forces: a smaller dynamics.step "
                               "reduces the difference"
                             : causes_of_heat;
    } else if (w.added > said_heat) {
        v.advice =
            fmt::format("{}: loads may add up to {:.3g} K, so smaller deviations are not detected",
                        found(w), heating().excess);
    }
}

RunCheck joints_verdict(double largest, double tolerance, std::int64_t step,
                        std::string const& of_step) {
    RunCheck v{"joints", largest <= tolerance, largest, tolerance, step, ""};
    if (!v.passed)
        v.advice = fmt::format(
            "constraint error {:.2e} above dynamics.constraint_tolerance {:.0e}: choose a smaller "
            "{}",
            largest, tolerance, of_step);
    return v;
}

double shortest_link(Scene const& scene) {
    double shortest = std::numeric_limits<double>::infinity();
    auto const look = [&](std::vector<double> const& length) {
        for (std::size_t k = 1; k < length.size(); ++k) shortest = std::min(shortest, length[k]);
    };
    for (ChainSpec const& chain : scene.chains) {
        look(chain.beads.length);
        look(chain.linked.length);
    }
    return std::isfinite(shortest) ? shortest : 0;
}

std::optional<RunCheck> coordinates_verdict(double largest, double length, double tolerance,
                                            std::int64_t step) {
    if (length <= 0) return std::nullopt;
    RunCheck v{"coordinates", true,
               largest,       tolerance * length / std::numeric_limits<double>::epsilon(),
               step,          ""};
    v.passed = v.value <= v.limit;
    if (!v.passed)
        v.advice = fmt::format(
            "a coordinate of {:.3g} does not resolve links of {:.3g} to "
            "dynamics.constraint_tolerance {:.0e}: move the chains closer to the origin",
            largest, length, tolerance);
    return v;
}

}  // namespace catena
