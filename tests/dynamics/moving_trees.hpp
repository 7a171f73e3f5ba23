// Systems of branched or cross-linked chains for tests: evaluations, steps and averages.
#pragma once

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "integrate/constrained_integrator.hpp"
#include "mpi/communicator.hpp"
#include "tests/integrate/constrained_run.hpp"

namespace catena::test {

/// A scene of these chains, and the system that moves it.
struct Trees {
    explicit Trees(std::vector<ChainSpec> chains, SolverSpec const& solver = {},
                   bool fixman = false, Vec3 const& gravity = Vec3::zero()) {
        scene.chains = std::move(chains);
        scene.solver = solver;
        if (solver.backend == Backend::automatic) scene.solver.backend = Backend::segments;
        scene.dynamics.fixman = fixman;
        scene.forces.gravity = gravity;
        system = std::make_unique<ChainSystem>(scene, Axes::world, *communicator);
    }
    /// Adds a force on each bead of the scene.
    void push(std::vector<Vec3> const& forces) {
        system->add_forces_by([this, forces] {
            std::int64_t next = 0;
            for (AbsoluteDynamics* group : system->absolute()) {
                View<3> const view = group->bead_forces();
                for (std::int64_t k = 0; k < view.size; ++k, ++next)
                    view.store(k, view.load(k) + forces[static_cast<std::size_t>(next)]);
            }
        });
    }
    Scene scene;
    std::unique_ptr<Communicator> communicator = serial_communicator();
    std::unique_ptr<ChainSystem> system;
};

inline SolverSpec solver_of(Backend backend, int threads = 1) {
    SolverSpec solver;
    solver.backend = backend;
    solver.threads = threads;
    return solver;
}

inline Vec3 vector3(nlohmann::json const& v) { return {{v.at(0), v.at(1), v.at(2)}}; }

/// Integrates the trees; steps count from 0.
class Motion {
  public:
    Motion(Trees& trees, ConstrainedScheme const& scheme)
        : system_(*trees.system), integrator_(scheme, system_.absolute()) {
        for (AbsoluteDynamics* const group : system_.absolute()) {
            group->update_configuration();
            group->assemble_matrices();
            group->draw_velocities(trees.scene.boltzmann() * 300, 7,
                                   std::vector<bool>(trees.scene.chains.size(), true));
        }
        begin();
        integrator_.choose_sweeps();
    }
    void steps(std::int64_t first, std::int64_t end) {
        for (std::int64_t n = first; n < end; ++n) {
            integrator_.step(n);
            system_.forces_and_matrices(nullptr);
        }
    }
    /// Makes configuration, matrices and forces ready.
    void begin() {
        for (AbsoluteDynamics* const group : system_.absolute()) group->update_configuration();
        system_.forces_and_matrices(nullptr);
    }
    SceneMotion snapshot() {
        integrator_.observe();
        return system_.snapshot();
    }
    ConstrainedIntegrator& integrator() { return integrator_; }

  private:
    ChainSystem& system_;
    ConstrainedIntegrator integrator_;
};

inline ConstrainedScheme langevin(Trees const& trees, double step) {
    return {Integrator::g_baoab, step, 1.0, trees.scene.boltzmann() * 300, 3, 1e-10};
}

struct Mean {
    double value = 0, error = 0;
};
/// Mean of independent values with its standard error.
inline Mean mean_of(std::vector<double> const& values) {
    auto const n = static_cast<double>(values.size());
    double const mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double square = 0;
    for (double const v : values) square += (v - mean) * (v - mean);
    return {mean, std::sqrt(square / (n * (n - 1)))};
}

}  // namespace catena::test
