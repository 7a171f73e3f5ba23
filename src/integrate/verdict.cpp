#include "integrate/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "integrate/observables.hpp"

namespace catena {
namespace {

/// Of the kinetic energy: a drift beyond the first makes a run worthless, one beyond the second is said, and so is a jump beyond the third.
constexpr double worthless_drift = 0.1, said_drift = 0.01, said_jump = 0.05;
/// Times the thermostat's: no start that is still cooling explains more over the second half of a run.
constexpr double worthless_heat = 3;
/// Of an equilibrated run.
constexpr double said_heat = 0.03, worthless_heat_in_equilibrium = 0.5;
constexpr double standard_errors = 5;
/// Friction times until a start is forgotten, and frames from which on a standard error says something.
constexpr double forgotten_after = 5;
constexpr std::size_t enough_frames = 8;

double mean_of(std::vector<double> const& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

bool any(std::vector<Vec3> const& values) {
    return std::any_of(values.begin(), values.end(), [](Vec3 const& v) { return norm(v) > 0; });
}

bool conserves_energy_of(ChainSpec const& chain) {
    BodyArrays const& b = chain.bodies;
    if (any(b.torque) || any(b.damping) || !b.driven.empty()) return false;
    if (std::any_of(b.wrench.begin(), b.wrench.end(), [](auto const& w) { return norm(w.first) + norm(w.second) > 0; })) return false;
    return std::none_of(b.drag.begin(), b.drag.end(), [](auto const& d) { return d[0] > 0 || d[1] > 0; });
}

/// Whether loads from outside keep chains moving, however cold the thermostat is.
bool is_pushed(Scene const& scene) {
    if (norm(scene.forces.gravity) > 0) return true;
    return std::any_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
        BodyArrays const& b = chain.bodies;
        return any(b.torque) || !b.driven.empty() ||
               std::any_of(b.wrench.begin(), b.wrench.end(), [](auto const& w) { return norm(w.first) + norm(w.second) > 0; });
    });
}

/// Whether kinetic energy is to tell the thermostat's temperature. Bodies in SI units that start at given velocities move far beyond
/// theirs.
bool is_thermal(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    if (!is_langevin(d.integrator) || is_implicit(d.integrator) || d.temperature <= 0 || d.friction <= 0) return false;
    if (is_pushed(scene)) return false;
    auto const any_chain = [&](auto const& is) { return std::any_of(scene.chains.begin(), scene.chains.end(), is); };
    return !scene.si || any_chain([](ChainSpec const& chain) { return chain.velocities == StartVelocities::thermal; });
}

bool starts_at_given_velocities(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
        return chain.velocities == StartVelocities::given &&
               (any(chain.beads.velocity) || any(chain.bodies.qd) || any(chain.linked.velocity) || any(chain.linked.omega) ||
                norm(chain.bodies.free_velocity) > 0);
    });
}

}  // namespace

nlohmann::json as_json(std::vector<RunCheck> const& verdicts) {
    nlohmann::json checks = nlohmann::json::array();
    for (RunCheck const& v : verdicts)
        checks.push_back(
            {{"name", v.name}, {"passed", v.passed}, {"value", v.value}, {"limit", v.limit}, {"step", v.step}, {"advice", v.advice}});
    return {{"valid", all_passed(verdicts)}, {"checks", checks}};
}

bool all_passed(std::vector<RunCheck> const& verdicts) {
    return std::all_of(verdicts.begin(), verdicts.end(), [](RunCheck const& v) { return v.passed; });
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
        for (std::size_t i = 0; i + 1 < blocks.size(); i += 2) blocks[i / 2] = 0.5 * (blocks[i] + blocks[i + 1]);
        blocks.resize(blocks.size() / 2);
    }
    return worst;
}

Fit fit_line(std::vector<double> const& values) {
    double const n = static_cast<double>(values.size()), middle = 0.5 * (n - 1), mean = mean_of(values);
    double along = 0, across = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        double const t = static_cast<double>(i) - middle;
        along += t * t;
        across += t * (values[i] - mean);
    }
    double const slope = across / along;
    std::vector<double> residual;
    for (std::size_t i = 0; i < values.size(); ++i) residual.push_back(values[i] - mean - slope * (static_cast<double>(i) - middle));
    // Correlated residuals count as the fewer independent ones that blocks tell of: the slope's error over that of a mean is 12^(1/2) / n.
    return {slope * (n - 1), std::sqrt(12.0) * standard_error(residual), mean};
}

bool EnergyWatch::conserves_energy(Scene const& scene) {
    if (is_langevin(scene.dynamics.integrator) || is_implicit(scene.dynamics.integrator)) return false;
    if (scene.forces.linear_drag > 0 || scene.forces.angular_drag > 0) return false;
    return std::all_of(scene.chains.begin(), scene.chains.end(), conserves_energy_of);
}

EnergyWatch::EnergyWatch(Scene const& scene) : scene_(scene), freedom_(static_cast<double>(degrees_of_freedom(scene))) {}

void EnergyWatch::add(std::int64_t step, double kinetic, std::optional<double> potential) {
    step_.push_back(step);
    kinetic_.push_back(kinetic);
    has_potential_ = has_potential_ && potential.has_value();
    if (has_potential_) total_.push_back(kinetic + *potential);
}

std::string EnergyWatch::span(double from, double to) const {
    return fmt::format("{:.5g} to {:.5g} {}", from, to, scene_.si ? "J" : "kJ/mol");
}

std::optional<RunCheck> EnergyWatch::energy() const {
    if (!conserves_energy(scene_) || !has_potential_ || total_.size() < 2) return std::nullopt;
    std::size_t const n = total_.size(), from = std::max<std::size_t>(1, n / 4);
    std::vector<double> const later(total_.begin() + static_cast<std::ptrdiff_t>(from), total_.end());
    Fit fit{later.back() - later.front(), 0, mean_of(later)};
    if (later.size() >= 4) fit = fit_line(later);
    double largest = 0;
    for (double const total : total_) largest = std::max(largest, std::abs(total));
    double const kinetic = *std::max_element(kinetic_.begin(), kinetic_.end()), scale = std::max(kinetic, 1e-6 * largest);
    RunCheck v{"energy", true, 0, worthless_drift, step_.back(), ""};
    if (scale == 0) return v;
    v.value = fit.change / scale;
    double const noise = standard_errors * fit.error / scale, jump = (later.front() - total_.front()) / scale;
    bool const drifts = std::abs(v.value) > noise;
    std::string const found = fmt::format(
        "total energy, which should be constant, drifted from {} between steps {} and {}, by {:.3g} +- {:.2g} of the kinetic energy",
        span(fit.mean - 0.5 * fit.change, fit.mean + 0.5 * fit.change), step_[from], step_.back(), v.value, fit.error / scale);
    if (!std::isfinite(v.value) || (drifts && std::abs(v.value) > worthless_drift)) {
        v.passed = false;
        v.advice = found + ": the step is too long: choose a smaller dynamics.step";
    } else if (drifts && std::abs(v.value) > said_drift) {
        v.advice = found + ": a smaller dynamics.step keeps it better";
    } else if (std::abs(jump) > said_jump) {
        v.advice = fmt::format(
            "total energy, which should be constant, jumped from {} between steps {} and {} and stayed there: the step is too "
            "long for the start: choose a smaller dynamics.step",
            span(total_.front(), later.front()), step_.front(), step_[from]);
    }
    return v;
}

std::optional<RunCheck> EnergyWatch::temperature() const {
    DynamicsSpec const& d = scene_.dynamics;
    if (!is_thermal(scene_) || freedom_ <= 0) return std::nullopt;
    std::size_t const n = kinetic_.size(), from = std::max<std::size_t>(1, n / 2);
    if (n < 2) return std::nullopt;
    std::vector<double> ratio;
    for (std::size_t i = from; i < n; ++i) ratio.push_back(2 * kinetic_[i] / (scene_.boltzmann() * freedom_ * d.temperature));
    double const mean = mean_of(ratio), canonical = std::sqrt(2 / freedom_);
    RunCheck v{"temperature", true, mean * d.temperature, worthless_heat * (1 + standard_errors * canonical) * d.temperature,
               step_.back(),  ""};
    std::string const found = fmt::format("temperature {:.4g} K over steps {} to {}, the thermostat's is {:.4g} K", v.value, step_[from],
                                          step_.back(), d.temperature);
    std::string const causes = ": the step is too long or the start overlaps: choose a smaller dynamics.step, or look at the start";
    double const before = static_cast<double>(step_[from] - step_.front()) * d.step;
    bool const forgotten = before * d.friction >= forgotten_after;
    if (!(v.value <= v.limit)) {
        // Velocities that the scene gives may be far from thermal until friction has taken them.
        v.passed = std::isfinite(v.value) && !forgotten && starts_at_given_velocities(scene_);
        v.advice = found + (v.passed ? ": the start's velocities are not forgotten yet: run longer" : causes);
        return v;
    }
    double const lasted = static_cast<double>(step_.back() - step_[from]) * d.step;
    if (ratio.size() < enough_frames || !forgotten) return v;
    double const independent = std::min(static_cast<double>(ratio.size()), std::max(1.0, lasted * d.friction));
    double const error = std::max(standard_error(ratio), canonical / std::sqrt(independent));
    double const away = std::abs(mean - 1);
    if (away <= said_heat || away <= standard_errors * error) return v;
    v.passed = mean < 1 + worthless_heat_in_equilibrium;
    v.advice = fmt::format("{} ({:.0f} standard errors away)", found, away / error);
    v.advice += v.passed ? ": the step is long for these forces: a smaller dynamics.step brings it nearer" : causes;
    return v;
}

RunCheck joints_verdict(double largest, double tolerance, std::int64_t step, std::string const& of_step) {
    RunCheck v{"joints", largest <= tolerance, largest, tolerance, step, ""};
    if (!v.passed)
        v.advice = fmt::format("constraint error {:.2e} above dynamics.constraint_tolerance {:.0e}: choose a smaller {}", largest,
                               tolerance, of_step);
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

std::optional<RunCheck> coordinates_verdict(double largest, double length, double tolerance, std::int64_t step) {
    if (length <= 0) return std::nullopt;
    RunCheck v{"coordinates", true, largest, tolerance * length / std::numeric_limits<double>::epsilon(), step, ""};
    v.passed = v.value <= v.limit;
    if (!v.passed)
        v.advice = fmt::format(
            "a coordinate of {:.3g} does not resolve links of {:.3g} to dynamics.constraint_tolerance {:.0e}: bring the "
            "chains near the origin",
            largest, length, tolerance);
    return v;
}

}  // namespace catena
