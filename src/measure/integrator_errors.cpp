// Work-precision studies of the integrators.
#include "measure/integrator_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "measure/integration.hpp"
#include "scene/freedom.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

// Number of energy samples per run, and k of the largest step, time / 2^k.
constexpr int samples_of_energy = 32, coarsest = 3;
constexpr double rounding = 1e-11;  // relative rounding of positions after thousands of steps
constexpr double too_wide = 0.01;   // error above which steps are too large to show an order
constexpr double unstable = 4;  // ratio to the reference's largest kinetic energy: twice its speeds

constexpr double tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

/// Treatment of a scene's springs by implicit integrators: no springs, supported, not supported on
/// a GPU, not supported because a joint's springs are uneven.
enum class Springs { none, implicit, on_gpu, uneven };
Springs springs_of(Scene const& scene) {
    bool any = false;
    DynamicsSpec some;
    some.integrator = Integrator::staggered;
    some.step = 1;  // arbitrary: without dampers the ratio of inertias does not depend on the step
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 0; k < chain.bodies.size(); ++k) {
            if (!scene::resists(chain.bodies, k)) continue;
            scene::ImplicitInertias const inertias =
                scene::implicit_inertias(chain.bodies, k, some);
            if (!inertias.are_definite() || !inertias.are_alike()) return Springs::uneven;
            any = true;
        }
    if (!any) return Springs::none;
    return uses_gpu(scene.solver.backend) ? Springs::on_gpu : Springs::implicit;
}
/// Returns why springs are treated by explicit integrators only.
std::string why_explicit_alone(Springs springs) {
    if (springs == Springs::on_gpu) return "they run on the host";
    if (springs == Springs::uneven)
        return "a joint has springs along only some of its coordinates, or its stiffnesses differ "
               "by ten decades";
    return "";
}

/// Returns the integrators that support all chains, the reference's first.
std::vector<Integrator> integrators_of(Scene const& scene) {
    bool joint = true, absolute = true;
    for (ChainSpec const& chain : scene.chains) {
        joint = joint && chain.bodies.size() > 0;
        absolute =
            absolute && !chain.has_loops() && !scene::joint_without_absolute_coordinates(chain);
    }
    bool const implicit = springs_of(scene) == Springs::implicit;
    std::vector<Integrator> all;
    if (joint) all = {Integrator::dormand_prince, Integrator::rk4, Integrator::velocity_verlet};
    if (joint && implicit) all.push_back(Integrator::staggered);
    if (absolute) all.insert(all.end(), {Integrator::rattle, Integrator::g_baoab});
    if (absolute && implicit) all.push_back(Integrator::implicit_g_baoab);
    return all;
}

/// Returns the extent of a configuration: largest distance from the first body, or from the origin
/// to the first body.
double extent(std::vector<Vec3> const& positions) {
    double largest = 0;
    for (Vec3 const& x : positions) largest = std::max(largest, norm(x - positions.front()));
    return std::max(largest, norm(positions.front()));
}
/// Returns the largest distance between corresponding bodies, divided by the extent of `b`.
double distance(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = larger(largest, norm(a[i] - b[i]));
    return largest / extent(b);
}

/// Energies of a run at a few samples, and its end.
struct RunResult {
    double change = 0, kinetic = 0;  // the largest
    std::vector<Vec3> end;
};
RunResult result_of(Scene const& scene, Communicator const& communicator, Stepping const& stepping,
                    std::int64_t steps) {
    Trajectory trajectory(scene, communicator, stepping);
    auto const start = trajectory.energy();
    RunResult result{0, start.kinetic, {}};
    std::int64_t const each = std::max<std::int64_t>(1, steps / samples_of_energy);
    for (std::int64_t done = 0; done < steps; done += each) {
        trajectory.run(each);
        auto const now = trajectory.energy();
        result.change = larger(result.change, std::abs(now.total - start.total));
        result.kinetic = larger(result.kinetic, now.kinetic);
    }
    result.end = trajectory.snapshot().position;
    return result;
}

/// Returns the slope of a line through the points' logarithms, by least squares.
double slope_of(std::vector<std::pair<double, double>> const& points) {
    double x = 0, y = 0, xx = 0, xy = 0;
    auto const count = static_cast<double>(points.size());
    for (auto const& [a, b] : points) x += std::log(a) / count, y += std::log(b) / count;
    for (auto const& [a, b] : points)
        xx += (std::log(a) - x) * (std::log(a) - x), xy += (std::log(a) - x) * (std::log(b) - y);
    return xy / xx;
}
/// Returns the order from the two finest steps with an error above `floor`; smaller errors are not
/// the integrator's.
std::optional<double> finest_slope(std::vector<IntegratorPoint> const& points, double floor) {
    for (std::size_t i = points.size(); i-- > 1;) {
        auto const &fine = points[i], &wide = points[i - 1];
        if (fine.no_error.empty() && wide.no_error.empty() && fine.error > floor)
            return slope_of({{wide.step, wide.error}, {fine.step, fine.error}});
    }
    return std::nullopt;
}
/// Returns the order from all steps of at least `shortest` with an error between `floor` and
/// `too_wide`.
std::optional<double> slope_from(double shortest, std::vector<IntegratorPoint> const& points,
                                 double floor) {
    std::vector<std::pair<double, double>> errors;
    for (IntegratorPoint const& p : points)
        if (p.no_error.empty() && p.error > floor && p.error < too_wide && p.step >= shortest)
            errors.emplace_back(p.step, p.error);
    return errors.size() < 2 ? std::nullopt : std::optional(slope_of(errors));
}

/// True if a force term does work on the bodies, so that the change of energy is not an error.
bool does_work(Scene const& scene) {
    return terms::any_of(
        [&](auto term) { return term.does_work && terms::acts_in<decltype(term)>(scene); });
}

/// The reference solution, and settings of the comparison.
struct Comparison {
    Scene const& scene;
    Communicator const& communicator;
    double time;
    int repeat;
    bool keeps_energy;
    std::vector<Vec3> end;
    double kinetic;  // largest kinetic energy
    double floor;    // smaller errors are not the integrator's
};
/// Runs one integrator with one step and compares it with the reference.
IntegratorPoint point_of(Comparison const& exact, Integrator integrator, std::int64_t steps,
                         double tolerance = 0) {
    IntegratorPoint point;
    point.step = exact.time / static_cast<double>(steps);
    point.error = NAN;
    point.tolerance = tolerance;
    Stepping const stepping{integrator, point.step, tolerance};
    try {
        RunResult const result = result_of(exact.scene, exact.communicator, stepping, steps);
        if (!(result.kinetic <= unstable * exact.kinetic)) {
            point.no_error = "unstable";
            return point;
        }
        point.error = distance(result.end, exact.end);
        if (exact.keeps_energy) point.energy_error = result.change / result.kinetic;
        std::vector<double> seconds;
        for (int i = 0; i < exact.repeat; ++i) {
            Trajectory trajectory(exact.scene, exact.communicator, stepping);
            double const start = seconds_now();
            trajectory.run(steps);
            seconds.push_back(seconds_now() - start);
            point.taken = trajectory.inner_steps().taken,
            point.rejected = trajectory.inner_steps().rejected;
        }
        point.seconds = spread_of(seconds);
    } catch (ComputationError const&) {
        point.no_error = "did not finish";
    }
    return point;
}
/// Runs one integrator with steps of time / 2^coarsest .. time / 2^last.
IntegratorCurve curve_of(Comparison const& exact, Integrator integrator, int last) {
    IntegratorCurve curve;
    curve.name = name_of(integrator);
    curve.order = traits_of(integrator).order;
    if (is_implicit(integrator)) curve.scheme = Scheme::implicit_springs;
    for (int k = coarsest; k <= last; ++k)
        curve.points.push_back(point_of(exact, integrator, std::int64_t{1} << k));
    curve.slope = finest_slope(curve.points, exact.floor);
    return curve;
}
/// Runs dormand-prince with all tolerances.
IntegratorCurve adaptive_curve(Comparison const& exact) {
    IntegratorCurve curve;
    curve.name = name_of(Integrator::dormand_prince);
    curve.scheme = Scheme::adaptive;
    for (double const tolerance : tolerances) {
        IntegratorPoint point =
            point_of(exact, Integrator::dormand_prince, std::int64_t{1} << coarsest, tolerance);
        point.allowed = std::max(exact.floor, tolerance * static_cast<double>(point.taken));
        curve.points.push_back(point);
    }
    return curve;
}
/// Returns the step from which on the explicit counterpart of an implicit integrator is unstable.
double limit_beside(IntegratorCurve const& implicit, std::vector<IntegratorCurve> const& curves) {
    bool const joint = implicit.name == name_of(Integrator::staggered);
    std::string const counterpart =
        name_of(joint ? Integrator::velocity_verlet : Integrator::g_baoab);
    auto const found = std::find_if(curves.begin(), curves.end(), [&](IntegratorCurve const& c) {
        return c.name == counterpart;
    });
    return found->unstable_from();
}

}  // namespace

bool IntegratorCurve::as_promised() const {
    auto const has_error = [](IntegratorPoint const& p) { return p.no_error.empty(); };
    auto const allowed = [](IntegratorPoint const& p) {
        return p.no_error.empty() && p.error <= p.allowed;
    };
    auto const near = [&](double found) { return found > order - 0.1 && found < order + 0.1; };
    if (exact || (too_stiff && !slow)) return true;
    if (scheme == Scheme::adaptive) return std::all_of(points.begin(), points.end(), allowed);
    bool const goes_on =
        scheme != Scheme::implicit_springs || std::all_of(points.begin(), points.end(), has_error);
    bool const shown_beyond =
        !slow || scheme != Scheme::implicit_springs || (slope_beyond && near(*slope_beyond));
    return goes_on && (points.empty() || has_error(points.back())) && slope && near(*slope) &&
           shown_beyond;
}

double IntegratorCurve::unstable_from() const {
    double shortest = 0;
    for (IntegratorPoint const& p : points)
        if (!p.no_error.empty() && (shortest == 0 || p.step < shortest)) shortest = p.step;
    return shortest;
}

bool IntegratorStudy::has_implicit() const {
    return std::any_of(curves.begin(), curves.end(), [](IntegratorCurve const& c) {
        return c.scheme == Scheme::implicit_springs;
    });
}

bool IntegratorStudy::valid() const {
    auto const finite = [](IntegratorPoint const& p) {
        return !p.no_error.empty() ||
               (std::isfinite(p.error) && std::isfinite(p.energy_error.value_or(0)));
    };
    return std::isfinite(reference_error) &&
           std::all_of(curves.begin(), curves.end(), [&](IntegratorCurve const& c) {
               return c.as_promised() && std::all_of(c.points.begin(), c.points.end(), finite);
           });
}

std::string why_integrators_cannot_be_compared(Scene const& scene) {
    if (scene.forces.openmm)
        return "OpenMM's forces are discontinuous at their cutoffs and have lists of their own";
    std::string changing;
    terms::for_each([&](auto term) {
        if (term.depends_on_velocities && terms::acts_in<decltype(term)>(scene))
            changing = fmt::format("its {} changes with velocities", term.in_messages);
    });
    if (!changing.empty()) return changing;
    for (ChainSpec const& c : scene.chains) {
        if (c.velocities == StartVelocities::thermal)
            return "its start is thermal and differs between integrators";
        if (!c.bodies.driven.empty()) return "its joints are driven";
    }
    return integrators_of(scene).empty() ? "no integrator supports all its chains" : "";
}

IntegratorStudy study_integrator_errors(Scene const& scene, Communicator const& communicator,
                                        double time, int finest, int repeat, bool slow) {
    IntegratorStudy study;
    study.title = scene.title;
    study.bodies = scene.bodies();
    study.time = time;
    bool const works = does_work(scene);
    if (works) study.no_energy_error = "torques or wrenches do work on the bodies";
    study.no_implicit = why_explicit_alone(springs_of(scene));
    std::vector<Integrator> const compared = integrators_of(scene);
    bool const springs = springs_of(scene) != Springs::none;
    if (springs) finest += 2;
    // A reference of second order has steps sixteen times finer than the finest: 1/256 of its
    // error, or rounding. A reference of fifth order has the finest step, or a quarter of it if
    // springs may be stiff.
    Integrator const judge = compared.front();
    bool const joint = uses_joint_coordinates(judge);
    if (joint) study.refine = scene.solver.refine;
    std::int64_t const most = std::int64_t{1} << (!joint    ? finest + 4
                                                  : springs ? finest + 2
                                                            : finest);
    study.reference = std::string(name_of(judge)) + ", " + std::to_string(most) + " steps";
    Comparison exact{scene, communicator, time, repeat, !works, {}, 0, 0};
    try {
        auto const run = [&](std::int64_t steps) {
            return result_of(scene, communicator, {judge, time / static_cast<double>(steps)},
                             steps);
        };
        RunResult const found = run(most);
        exact.end = found.end, exact.kinetic = found.kinetic;
        study.reference_error = distance(run(most / 2).end, exact.end);
    } catch (ComputationError const&) {
        study.reference_error = std::numeric_limits<double>::infinity();
        return study;
    }
    exact.floor = std::max(20 * study.reference_error, rounding);
    for (Integrator const integrator : compared) {
        bool const early = integrator == Integrator::rk4 && !springs;
        IntegratorCurve curve = is_adaptive(integrator)
                                    ? adaptive_curve(exact)
                                    : curve_of(exact, integrator, early ? finest - 3 : finest);
        auto const& points = curve.points;
        curve.exact = exact.floor == rounding &&
                      std::all_of(points.begin(), points.end(),
                                  [](auto const& p) { return p.error <= rounding; });
        auto const stable = std::count_if(points.begin(), points.end(),
                                          [](auto const& p) { return p.no_error.empty(); });
        curve.too_stiff = springs && curve.scheme == Scheme::explicit_steps && stable < 2;
        study.curves.push_back(curve);
    }
    // The reference's curve is the last, so that pictures without it have the others in the same
    // colours.
    if (joint) std::rotate(study.curves.begin(), study.curves.begin() + 1, study.curves.end());
    for (IntegratorCurve& curve : study.curves) {
        double const limit =
            curve.scheme == Scheme::implicit_springs ? limit_beside(curve, study.curves) : 0;
        curve.slow = slow;
        if (limit > 0) curve.slope_beyond = slope_from(limit, curve.points, exact.floor);
    }
    return study;
}

DriftStudy study_drift(Scene const& scene, Communicator const& communicator, Integrator integrator,
                       double step, std::int64_t steps) {
    constexpr int blocks = 50, samples = 200;  // samples per block
    std::int64_t const each = std::max<std::int64_t>(1, steps / (blocks * samples));
    Trajectory trajectory(scene, communicator, {integrator, step});
    std::vector<double> mean(blocks, 0.0);
    double kinetic = 0, sum = 0, squares = 0, first = trajectory.energy().total;
    for (double& block : mean)
        for (int i = 0; i < samples; ++i) {
            trajectory.run(each);
            auto const now = trajectory.energy();
            double const off = now.total - first;
            block += off / samples;
            sum += off, squares += off * off, kinetic += now.kinetic;
        }
    double const count = blocks * samples, block_time = samples * static_cast<double>(each) * step;
    DriftStudy study{
        scene.title, name_of(integrator), step, each * blocks * samples, kinetic / count, 0, 0, 0};
    study.scatter = std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
    double times = 0, cross_sum = 0, rest = 0, average = 0;
    for (double const m : mean) average += m / blocks;
    for (int b = 0; b < blocks; ++b) {
        double const t = (b - 0.5 * (blocks - 1)) * block_time;
        times += t * t, cross_sum += t * (mean[static_cast<std::size_t>(b)] - average);
    }
    study.slope = cross_sum / times;
    for (int b = 0; b < blocks; ++b) {
        double const t = (b - 0.5 * (blocks - 1)) * block_time,
                     off = mean[static_cast<std::size_t>(b)] - average - study.slope * t;
        rest += off * off;
    }
    study.slope_error = std::sqrt(rest / (blocks - 2) / times);
    return study;
}

}  // namespace catena
