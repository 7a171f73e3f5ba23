// Runs of the constrained integrators inside a test, and what they must keep.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrate/constrained_integrator.hpp"
#include "observe/observables.hpp"
#include "reader/load_scene.hpp"

namespace catena::test {

/// A constrained run without output.
class Constrained {
  public:
    Constrained(std::string const& text, double step, Integrator kind = Integrator::rattle,
                double friction = 0, double kt = 0)
        : scene_(quiet(parse_scene(text, "scene.yaml"))),
          system_(scene_, Axes::world, *communicator_),
          integrator_({kind, step, friction, kt, 1, 1e-12}, system_.absolute()) {
        for (AbsoluteDynamics* group : system_.absolute()) {
            group->update_configuration();
            group->assemble_matrices();
            group->draw_velocities(scene_.boltzmann() * 300, 7,
                                   std::vector<bool>(scene_.chains.size(), true));
        }
        system_.forces_and_matrices(nullptr);
        integrator_.choose_sweeps();
    }
    void run(std::int64_t steps) {
        for (std::int64_t i = 0; i < steps; ++i) {
            integrator_.step(done_++);
            system_.forces_and_matrices(nullptr);
        }
    }
    SceneMotion snapshot() {
        integrator_.observe();
        return system_.snapshot();
    }
    double energy() {
        SceneMotion const s = snapshot();
        double e = kinetic_energy(scene_, s);
        for (EnergyTerm const& term : system_.potential_energy()) e += term.value;
        return e;
    }
    double constraint_error() {
        double worst = 0;
        for (AbsoluteDynamics* group : system_.absolute())
            worst = larger(worst, group->constraint_error());
        return worst;
    }
    Scene const& scene() const { return scene_; }

  private:
    /// Without the generator's torques and wrenches, so that energy and momentum are kept.
    static Scene quiet(Scene scene) {
        for (ChainSpec& chain : scene.chains) {
            chain.bodies.torque.clear();
            chain.bodies.wrench.clear();
        }
        return scene;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
    Scene scene_;
    ChainSystem system_;
    ConstrainedIntegrator integrator_;
    std::int64_t done_ = 0;
};

/// Of all chains, about the origin of the ground; `size`: what it sums up.
struct Momenta {
    Vec3 linear = Vec3::zero(), angular = Vec3::zero();
    double size = 0;
};
inline Momenta momenta(Scene const& scene, SceneMotion const& s) {
    Momenta m;
    std::size_t i = 0;
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 0; k < chain.size(); ++k, ++i) {
            bool const linked = chain.is_linked();
            std::vector<double> const& masses = chain.is_beads() ? chain.beads.mass
                                                : linked         ? chain.linked.mass
                                                                 : chain.bodies.mass;
            Vec3 const p = masses[k] * s.velocity[i];
            m.linear = m.linear + p;
            m.angular = m.angular + cross(s.position[i], p);
            Sym3 const inertia = chain.is_beads() ? Sym3::zero()
                                 : linked         ? chain.linked.inertia[k]
                                                  : chain.bodies.inertia[k];
            m.angular = m.angular + to_matrix(s.orientation[i]) * (inertia * s.omega[i]);
            m.size += norm(p) * (1 + norm(s.position[i]));
        }
    return m;
}

}  // namespace catena::test
