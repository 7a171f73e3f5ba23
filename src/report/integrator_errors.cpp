#include "report/integrator_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "error.hpp"
#include "integrate/observables.hpp"
#include "integrate/stepper.hpp"
#include "scene/freedom.hpp"

namespace catena {
namespace {

constexpr int samples_of_energy = 32, coarsest = 3;
constexpr double constraint_tolerance = 1e-13;
constexpr double rounding = 1e-11;  // of positions after thousands of steps, relative

/// A scene's integrator, without files.
class Trajectory {
  public:
    Trajectory(Scene scene, Communicator const& communicator, Integrator integrator, double step)
        : scene_(with(std::move(scene), integrator, step)),
          system_(scene_, uses_joint_coordinates(integrator) ? Axes::joint : Axes::world, communicator),
          stepper_(make_stepper(system_, scene_.dynamics)) {
        stepper_->prepare(nullptr);
    }
    void run(std::int64_t steps) {
        for (std::int64_t i = 0; i < steps; ++i) {
            stepper_->step(done_++, nullptr);
            stepper_->prepare(nullptr);
        }
        system_.wait();
    }
    ChainSystem::Snapshot snapshot() {
        stepper_->observe(false);
        return system_.snapshot();
    }
    struct Energy {
        double kinetic = 0, total = 0;
    };
    Energy energy() {
        Energy e;
        e.total = e.kinetic = kinetic_energy(scene_, snapshot());
        for (EnergyTerm const& term : system_.potential_energy()) e.total += term.value;
        return e;
    }

  private:
    static Scene with(Scene scene, Integrator integrator, double step) {
        scene.dynamics.given = true;
        scene.dynamics.integrator = integrator;
        scene.dynamics.step = step;
        scene.dynamics.friction = 0;
        scene.dynamics.constraint_tolerance = constraint_tolerance;
        return scene;
    }
    Scene scene_;
    ChainSystem system_;
    std::unique_ptr<Stepper> stepper_;
    std::int64_t done_ = 0;
};

int order_of(Integrator integrator) { return integrator == Integrator::rk4 ? 4 : 2; }

std::vector<Integrator> integrators_of(Scene const& scene) {
    bool joint = true, absolute = true;
    for (ChainSpec const& chain : scene.chains) {
        joint = joint && chain.bodies.size() > 0;
        absolute = absolute && !scene::joint_without_absolute_coordinates(chain);
    }
    std::vector<Integrator> all;
    if (joint) all = {Integrator::rk4, Integrator::velocity_verlet};
    if (absolute) all.insert(all.end(), {Integrator::rattle, Integrator::g_baoab});
    return all;
}

double extent(std::vector<Vec3> const& positions) {
    double largest = 0;
    for (Vec3 const& x : positions) largest = std::max(largest, norm(x - positions.front()));
    return std::max(largest, norm(positions.front()));
}
double distance(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = larger(largest, norm(a[i] - b[i]));
    return largest / extent(b);
}

std::vector<Vec3> end_of(Scene const& scene, Communicator const& communicator, Integrator integrator, double time, std::int64_t steps) {
    Trajectory trajectory(scene, communicator, integrator, time / static_cast<double>(steps));
    trajectory.run(steps);
    return trajectory.snapshot().position;
}

double energy_error(Scene const& scene, Communicator const& communicator, Integrator integrator, double time, std::int64_t steps) {
    Trajectory trajectory(scene, communicator, integrator, time / static_cast<double>(steps));
    auto const start = trajectory.energy();
    double worst = 0, kinetic = start.kinetic;
    std::int64_t const each = std::max<std::int64_t>(1, steps / samples_of_energy);
    for (std::int64_t done = 0; done < steps; done += each) {
        trajectory.run(each);
        auto const now = trajectory.energy();
        worst = larger(worst, std::abs(now.total - start.total));
        kinetic = std::max(kinetic, now.kinetic);
    }
    return worst / kinetic;
}

/// Errors below `floor` are not the integrator's.
std::optional<double> finest_slope(std::vector<IntegratorPoint> const& points, double floor) {
    for (std::size_t i = points.size(); i-- > 1;)
        if (points[i].error > floor) return std::log(points[i - 1].error / points[i].error) / std::log(points[i - 1].step / points[i].step);
    return std::nullopt;
}

/// Joint torques and wrenches: what they do to the bodies is work, and the energy's change no error.
bool works_on_bodies(ChainSpec const& chain) {
    auto const is_zero = [](Vec3 const& v) { return norm(v) == 0; };
    auto const& [torque, wrench] = std::tie(chain.bodies.torque, chain.bodies.wrench);
    return !std::all_of(torque.begin(), torque.end(), is_zero) ||
           !std::all_of(wrench.begin(), wrench.end(), [&](auto const& w) { return is_zero(w.first) && is_zero(w.second); });
}

struct Course {
    double time;
    std::int64_t steps;
    int repeat;
    bool keeps_energy;
};
IntegratorPoint point_of(Scene const& scene, Communicator const& communicator, Integrator integrator, Course const& course,
                         std::vector<Vec3> const& exact) {
    IntegratorPoint point{course.time / static_cast<double>(course.steps), NAN, {}, {}};
    try {
        std::vector<double> seconds;
        for (int i = 0; i < course.repeat; ++i) {
            Trajectory trajectory(scene, communicator, integrator, point.step);
            double const start = seconds_now();
            trajectory.run(course.steps);
            seconds.push_back(seconds_now() - start);
            if (i == 0) point.error = distance(trajectory.snapshot().position, exact);
        }
        point.seconds = spread_of(seconds);
        if (course.keeps_energy) point.energy_error = energy_error(scene, communicator, integrator, course.time, course.steps);
    } catch (ComputationError const&) {
        return {point.step, NAN, {}, {}, false};
    }
    return point;
}

}  // namespace

bool IntegratorStudy::valid() const {
    auto const finite = [](IntegratorPoint const& p) {
        return !p.finished || (std::isfinite(p.error) && std::isfinite(p.energy_error.value_or(0)));
    };
    return std::isfinite(reference_error) && std::all_of(curves.begin(), curves.end(), [&](IntegratorCurve const& c) {
               return c.as_promised() && std::all_of(c.points.begin(), c.points.end(), finite);
           });
}

std::string why_integrators_cannot_be_compared(Scene const& scene) {
    if (scene.forces.openmm) return "OpenMM's forces have steps at their cutoffs, and lists of their own";
    if (scene.forces.linear_drag != 0 || scene.forces.angular_drag != 0) return "its drag changes with velocities";
    for (ChainSpec const& c : scene.chains) {
        if (c.velocities == StartVelocities::thermal) return "its start is thermal, another one for every integrator";
        if (!c.bodies.drag.empty() || !c.bodies.damping.empty()) return "its drag or dampers change with velocities";
        if (!c.bodies.driven.empty()) return "its joints are driven";
    }
    return integrators_of(scene).empty() ? "no integrator has all its chains" : "";
}

IntegratorStudy study_integrator_errors(Scene const& scene, Communicator const& communicator, double time, int finest, int repeat) {
    IntegratorStudy study;
    study.title = scene.title;
    study.bodies = scene.bodies();
    study.time = time;
    bool const works = std::any_of(scene.chains.begin(), scene.chains.end(), works_on_bodies);
    if (works) study.no_energy_error = "torques or wrenches work on the bodies";
    std::vector<Integrator> const integrators = integrators_of(scene);
    // Sixteen times finer than the finest of its own order: 1/256 of that one's error, or rounding.
    Integrator const judge = integrators.front();
    std::int64_t const most = std::int64_t{1} << (judge == Integrator::rk4 ? finest : finest + 4);
    study.reference = std::string(name_of(judge)) + ", " + std::to_string(most) + " steps";
    std::vector<Vec3> exact;
    try {
        exact = end_of(scene, communicator, judge, time, most);
        study.reference_error = distance(end_of(scene, communicator, judge, time, most / 2), exact);
    } catch (ComputationError const&) {
        study.reference_error = std::numeric_limits<double>::infinity();
        return study;
    }
    double const floor = std::max(20 * study.reference_error, rounding);
    for (Integrator const integrator : integrators) {
        IntegratorCurve curve{name_of(integrator), order_of(integrator), {}, {}, false};
        int const last = integrator == Integrator::rk4 ? finest - 3 : finest;
        for (int k = coarsest; k <= last; ++k) {
            std::int64_t const steps = std::int64_t{1} << k;
            curve.points.push_back(point_of(scene, communicator, integrator, {time, steps, repeat, !works}, exact));
        }
        curve.slope = finest_slope(curve.points, floor);
        curve.exact =
            floor == rounding && std::all_of(curve.points.begin(), curve.points.end(), [](auto const& p) { return p.error <= rounding; });
        study.curves.push_back(curve);
    }
    return study;
}

DriftStudy study_drift(Scene const& scene, Communicator const& communicator, Integrator integrator, double step, std::int64_t steps) {
    constexpr int blocks = 50, samples = 200;  // samples: of a block
    std::int64_t const each = std::max<std::int64_t>(1, steps / (blocks * samples));
    Trajectory trajectory(scene, communicator, integrator, step);
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
    DriftStudy study{scene.title, name_of(integrator), step, each * blocks * samples, kinetic / count, 0, 0, 0};
    study.scatter = std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
    double times = 0, cross_sum = 0, rest = 0, average = 0;
    for (double const m : mean) average += m / blocks;
    for (int b = 0; b < blocks; ++b) {
        double const t = (b - 0.5 * (blocks - 1)) * block_time;
        times += t * t, cross_sum += t * (mean[static_cast<std::size_t>(b)] - average);
    }
    study.slope = cross_sum / times;
    for (int b = 0; b < blocks; ++b) {
        double const t = (b - 0.5 * (blocks - 1)) * block_time, off = mean[static_cast<std::size_t>(b)] - average - study.slope * t;
        rest += off * off;
    }
    study.slope_error = std::sqrt(rest / (blocks - 2) / times);
    return study;
}

}  // namespace catena
