// Implements the bound on the heating by external loads.
#include "observe/heating.hpp"

#include <algorithm>
#include <cmath>

#include "joints/joint_models.hpp"
#include "observe/observables.hpp"
#include "scene/branches.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

/// Inverse of a body's inertia; not finite if the body has none about some axis.
Sym3 inverse_of(Sym3 const& m) {
    Sym3 adjoint;
    adjoint(0, 0) = m(1, 1) * m(2, 2) - m(1, 2) * m(1, 2);
    adjoint(1, 1) = m(0, 0) * m(2, 2) - m(0, 2) * m(0, 2);
    adjoint(2, 2) = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1);
    adjoint(1, 0) = m(0, 2) * m(1, 2) - m(0, 1) * m(2, 2);
    adjoint(2, 0) = m(0, 1) * m(1, 2) - m(0, 2) * m(1, 1);
    adjoint(2, 1) = m(0, 1) * m(0, 2) - m(0, 0) * m(1, 2);
    double const determinant =
        m(0, 0) * adjoint(0, 0) + m(0, 1) * adjoint(0, 1) + m(0, 2) * adjoint(0, 2);
    for (double& value : adjoint.data) value /= determinant;
    return adjoint;
}

/// Upper bound on the largest eigenvalue: the root of the sum of squares (Frobenius norm).
double largest_of(Sym3 const& m) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += m(i, j) * m(i, j);
    return std::sqrt(sum);
}

/// Sum of the loads on one body, each divided by the root of the inertia that it accelerates.
/// Magnitudes are added, since loads may have equal directions at some time.
class Pushes {
  public:
    Pushes(double mass, Sym3 const& inertia) : mass_(mass), inverse_(inverse_of(inertia)) {}
    void force(double size) {
        if (size > 0) sum_ += size / std::sqrt(mass_);
    }
    /// Adds a torque of any direction.
    void torque(double size) {
        if (size > 0) sum_ += size * std::sqrt(largest_of(inverse_));
    }
    /// Adds a torque with components along the body's axes.
    void torque(Vec3 const& torque) {
        if (norm(torque) > 0) sum_ += std::sqrt(dot(torque, inverse_ * torque));
    }
    /// f M^-1 f of this body at most.
    double square() const { return sum_ * sum_; }

  private:
    double mass_;
    Sym3 inverse_;
    double sum_ = 0;
};

/// Adds a joint's torque on its outboard body and the opposite torque on its inboard body. A force
/// acts with its arms on both.
void add_torque(BodyArrays const& b, scene::Parents parents, std::size_t k,
                std::vector<Pushes>& pushes) {
    Vec3 const& torque = b.torque[k];
    double size = 0, pushing = 0, shift = 0;
    for (int i = 0; i < 3; ++i) {
        bool const length = is_length(b.joint[k], i);
        (length ? pushing : size) += std::abs(torque[i]);
        if (length) shift += std::abs(b.q[k][static_cast<std::size_t>(i)]);
    }
    if (turns_twice(b.joint[k]))
        size /= norm(cross(b.first_axis[k],
                           b.axis[k]));  // axes that are not perpendicular require larger torques
    std::size_t const before = k > 0 ? scene::inboard_of(parents, k) : 0;
    Pushes* const inboard = k > 0 ? &pushes[before] : nullptr;
    if (pivots(b.joint[k])) {
        pushes[k].torque(torque[0] * b.axis[k]);
        if (inboard) inboard->torque(torque[0] * (b.rotation[k] * b.axis[k]));
        return;
    }
    pushes[k].torque(size), pushes[k].force(pushing);
    pushes[k].torque(pushing * norm(b.com[k]));
    if (!inboard) return;
    inboard->torque(size), inboard->force(pushing);
    inboard->torque(pushing * (norm(b.translation[k] - b.com[before]) + shift));
}

/// Size of the constant forces on body k whose energy a column counts.
double held_force(ChainSpec const& chain, std::size_t k) {
    double sum = 0;
    terms::for_each([&](auto term) {
        terms::ConstantWrench own;
        if (term.energy != nullptr && decltype(term)::constant_wrench(chain, k, own))
            sum += norm(own.second);
    });
    return sum;
}

/// Adds the constant wrenches on body k whose work no column counts.
void add_wrenches(ChainSpec const& chain, std::size_t k, Pushes& pushes) {
    terms::for_each([&](auto term) {
        terms::ConstantWrench own;
        if (term.does_work && decltype(term)::constant_wrench(chain, k, own))
            pushes.force(norm(own.second)), pushes.torque(norm(own.first));
    });
}

/// Upper bound of f M^-1 f of beads and bodies on links that nothing holds, as square_of().
double square_of_links(ChainSpec const& chain, std::vector<double> const& masses, double gravity,
                       bool with_potentials) {
    double sum = 0;
    for (std::size_t k = 0; k < masses.size(); ++k) {
        double const mass = masses[k], force = with_potentials ? held_force(chain, k) : 0;
        sum += force == 0 ? mass * gravity * gravity
                          : (mass * gravity + force) * (mass * gravity + force) / mass;
    }
    return sum;
}

/// Upper bound of f M^-1 f: the value for bodies that no joint holds. Without `with_potentials`,
/// gravity and other forces whose energy a column counts are left out.
double square_of(Scene const& scene, ChainSpec const& chain, bool with_potentials) {
    double const gravity = with_potentials ? norm(scene.forces.gravity) : 0;
    double sum = square_of_links(chain, chain.beads.mass, gravity, with_potentials);
    sum += square_of_links(chain, chain.linked.mass, gravity, with_potentials);
    BodyArrays const& b = chain.bodies;
    std::vector<Pushes> pushes;
    for (std::size_t k = 0; k < b.size(); ++k) pushes.emplace_back(b.mass[k], b.inertia[k]);
    for (std::size_t k = 0; k < b.size(); ++k) {
        pushes[k].force(gravity * b.mass[k]);
        add_wrenches(chain, k, pushes[k]);
        if (with_potentials) pushes[k].force(held_force(chain, k));
        if (!b.torque.empty()) add_torque(b, chain.parent, k, pushes);
    }
    for (Pushes const& each : pushes) sum += each.square();
    return sum;
}

}  // namespace

/// x / tanh x is 1 + x^2 / 3 for small x.
double drift_of_step(DynamicsSpec const& d) {
    double const x = 0.5 * d.friction * d.step;
    return x < 1e-4 ? 1 : x / std::tanh(x);
}

Heating heating_of(Scene const& scene, bool with_potentials) {
    auto const any = [&](auto const& is) {
        return std::any_of(scene.chains.begin(), scene.chains.end(), is);
    };
    bool const driven = any([](ChainSpec const& chain) { return !chain.bodies.driven.empty(); });
    Heating found;
    found.is_pushed = driven || terms::any_of([&](auto term) {
                          return term.pushes && terms::acts_in<decltype(term)>(scene);
                      });
    if (!found.is_pushed) return found;
    if (driven) {
        found.unknown = "motions are prescribed, whose kinetic energy is not thermal";
        return found;
    }
    double sum = 0;
    for (ChainSpec const& chain : scene.chains) sum += square_of(scene, chain, with_potentials);
    double const friction = scene.dynamics.friction / drift_of_step(scene.dynamics);
    found.excess = sum / (friction * friction * static_cast<double>(degrees_of_freedom(scene)) *
                          scene.boltzmann());
    if (!std::isfinite(found.excess)) found.unknown = "torques act about axes without inertia";
    return found;
}

}  // namespace catena
