// Implements the bound on the heating by external loads.
#include "observe/heating.hpp"

#include <algorithm>
#include <cmath>

#include "joints/joint_models.hpp"
#include "observe/observables.hpp"

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
void add_torque(BodyArrays const& b, std::size_t k, std::vector<Pushes>& pushes) {
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
    Pushes* const inboard = k > 0 ? &pushes[k - 1] : nullptr;
    if (pivots(b.joint[k])) {
        pushes[k].torque(torque[0] * b.axis[k]);
        if (inboard) inboard->torque(torque[0] * (b.rotation[k] * b.axis[k]));
        return;
    }
    pushes[k].torque(size), pushes[k].force(pushing);
    pushes[k].torque(pushing * norm(b.com[k]));
    if (!inboard) return;
    inboard->torque(size), inboard->force(pushing);
    inboard->torque(pushing * (norm(b.translation[k] - b.com[k - 1]) + shift));
}

/// Upper bound of f M^-1 f: the value for bodies that no joint holds. `gravity`: acceleration, 0 if
/// it does not count.
double square_of(ChainSpec const& chain, double gravity) {
    double sum = 0;
    for (double const mass : chain.beads.mass) sum += mass * gravity * gravity;
    for (double const mass : chain.linked.mass) sum += mass * gravity * gravity;
    BodyArrays const& b = chain.bodies;
    std::vector<Pushes> pushes;
    for (std::size_t k = 0; k < b.size(); ++k) pushes.emplace_back(b.mass[k], b.inertia[k]);
    for (std::size_t k = 0; k < b.size(); ++k) {
        pushes[k].force(gravity * b.mass[k]);
        if (!b.wrench.empty())
            pushes[k].force(norm(b.wrench[k].second)), pushes[k].torque(norm(b.wrench[k].first));
        if (!b.torque.empty()) add_torque(b, k, pushes);
    }
    for (Pushes const& each : pushes) sum += each.square();
    return sum;
}

/// True if the chain has prescribed motions, joint torques or wrenches.
bool has_load(ChainSpec const& chain) {
    BodyArrays const& b = chain.bodies;
    return !b.driven.empty() ||
           std::any_of(b.torque.begin(), b.torque.end(),
                       [](Vec3 const& torque) { return norm(torque) > 0; }) ||
           std::any_of(b.wrench.begin(), b.wrench.end(),
                       [](auto const& w) { return norm(w.first) + norm(w.second) > 0; });
}

}  // namespace

/// x / tanh x is 1 + x^2 / 3 for small x.
double drift_of_step(DynamicsSpec const& d) {
    double const x = 0.5 * d.friction * d.step;
    return x < 1e-4 ? 1 : x / std::tanh(x);
}

Heating heating_of(Scene const& scene, bool with_gravity) {
    auto const any = [&](auto const& is) {
        return std::any_of(scene.chains.begin(), scene.chains.end(), is);
    };
    double const gravity = norm(scene.forces.gravity);
    Heating found;
    found.is_pushed = gravity > 0 || any(has_load);
    if (!found.is_pushed) return found;
    if (any([](ChainSpec const& chain) { return !chain.bodies.driven.empty(); })) {
        found.unknown = "motions are prescribed, whose kinetic energy is not thermal";
        return found;
    }
    double sum = 0;
    for (ChainSpec const& chain : scene.chains) sum += square_of(chain, with_gravity ? gravity : 0);
    double const friction = scene.dynamics.friction / drift_of_step(scene.dynamics);
    found.excess = sum / (friction * friction * static_cast<double>(degrees_of_freedom(scene)) *
                          scene.boltzmann());
    if (!std::isfinite(found.excess)) found.unknown = "torques act about axes without inertia";
    return found;
}

}  // namespace catena
