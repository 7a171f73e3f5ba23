// Work-precision study of the solver.
#include "measure/solver_errors.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "error.hpp"
#include "measure/oracle_accelerations.hpp"
#include "scene/branch_limits.hpp"
#include "scene/freedom.hpp"
#include "start/start_velocities.hpp"

namespace catena {
namespace {

/// True if all values are finite.
bool finite(std::vector<double> const& values) {
    double sum = 0;
    for (double const v : values) sum += 0.0 * v;
    return sum == 0;
}

/// Reference accelerations of a scene. They are computed after the first point, which supplies
/// OpenMM's forces.
struct Reference {
    std::vector<double> acceleration;
    void make(SolverStudy& study, Scene const& scene, Solution const& first, int repeat) {
        bool const quad = study.bodies <= largest_quad;
        study.reference = quad ? "articulated bodies, 113 bits" : "articulated bodies, 64 bits";
        acceleration = quad ? oracle_accelerations<oracle::Quad>(scene, first.bead_force)
                            : oracle_accelerations<long double>(scene, first.bead_force);
        std::vector<double> seconds, in_double;
        for (int i = 0; i < repeat; ++i) {
            double const start = seconds_now();
            in_double = oracle_accelerations<double>(scene, first.bead_force);
            seconds.push_back(seconds_now() - start);
        }
        study.oracle_seconds = spread_of(seconds);
        Solution oracle = first;
        oracle.acceleration = in_double;
        study.oracle_error = largest_difference(scene, oracle, acceleration);
    }
};

/// Returns the largest condition number of a chain; absent if no chain has a joint.
std::optional<double> largest_condition_number(Scene const& scene) {
    std::optional<double> largest;
    for (ChainSpec const& chain : scene.chains) {
        bool const no_joint = chain.is_beads() && chain.size() == 1 && chain.base == Base::free;
        if (!no_joint) largest = larger(largest.value_or(0), oracle::condition_estimate(chain));
    }
    return largest;
}

/// Returns the handle kinds of all chains, joined by "+".
std::string kinds_of(Scene const& scene) {
    std::set<std::string> kinds;
    for (ChainSpec const& chain : scene.chains) kinds.insert(kind_of(chain));
    std::string joined;
    for (std::string const& kind : kinds) joined += (joined.empty() ? "" : "+") + kind;
    return joined;
}

}  // namespace

std::vector<Backend> cpu_backends() {
    std::vector<Backend> backends{Backend::serial, Backend::segments};
    if (openmp_is_built()) backends.push_back(Backend::openmp);
    return backends;
}

SolverStudy study_solver_errors(Scene const& given, Communicator const& communicator,
                                std::vector<Backend> const& backends,
                                std::vector<Handles> const& handles, int repeat) {
    bool const root = communicator.rank() == 0;
    Scene const scene = with_start_velocities(given, communicator);
    SolverStudy study;
    study.title = scene.title;
    study.file = scene.file;
    study.kind = kinds_of(scene);
    study.bodies = scene.bodies();
    study.ranks = communicator.size();
    if (root && study.bodies <= largest_condition)
        study.condition = largest_condition_number(scene);
    Reference reference;
    bool const takes_articulated =
        std::all_of(scene.chains.begin(), scene.chains.end(), scene::takes_articulated_handles);
    bool const only_trees =
        std::all_of(scene.chains.begin(), scene.chains.end(), scene::is_body_tree);
    for (Backend const backend : backends)
        for (Handles const kind : handles) {
            if (kind == Handles::articulated && !takes_articulated) continue;
            if (only_trees ? kind != Handles::articulated
                           : !study.points.empty() && kind != Handles::projected &&
                                 scene::has_paths(scene))
                continue;
            Scene variant = scene;
            variant.solver.backend = backend;
            variant.solver.handles = kind;
            variant.dynamics.fixman = false;  // the oracles do not know its forces
            ChainSystem system(variant, Axes::joint, communicator);
            SolverPoint point{
                name_of(backend), name_of(kind), system.executor().threads(), 0, 0, 0, {}, false};
            point.seconds = time_evaluations(system, repeat).evaluation;
            point.residual = system.residual();
            point.residual_bound = system.residual_bound();
            Solution const solution = solution_of(system);
            if (root) {
                if (study.points.empty()) reference.make(study, scene, solution, repeat);
                point.forward_error = largest_difference(scene, solution, reference.acceleration);
                point.valid =
                    finite(solution.acceleration) && point.residual <= point.residual_bound;
            }
            study.points.push_back(point);
        }
    return study;
}

}  // namespace catena
