// The error estimate of iterative refinement.
#include "dynamics/joint/joint_correction.hpp"

#include <algorithm>

#include "dynamics/absolute_dynamics.hpp"

namespace catena {
namespace {

double largest_norm(ConstView<3> const& vectors, std::int64_t count) {
    double worst = 0;
    for (std::int64_t k = 0; vectors.origin && k < count; ++k)
        worst = larger(worst, norm(vectors.load(k)));
    return worst;
}

double trace_of(Vector<double, 6> const& inertia) {
    Sym3 const all = as_symmetric(inertia);
    return all(0, 0) + all(1, 1) + all(2, 2);
}

/// change / size, with 0 / 0 = 0.
double ratio(double change, double size) { return change == 0 ? 0.0 : change / size; }

}  // namespace

double RefinedSolution::relative_change(Communicator const& communicator) const {
    auto const largest = [&](ConstView<3> const& vectors) {
        return communicator.max(largest_norm(vectors, group.size));
    };
    double mass = 0, inertia = 0;
    for (std::int64_t k = 0; k < group.size; ++k) {
        mass = std::max(mass, group.bodies.mass.view().at(k, 0));
        inertia = std::max(inertia, trace_of(group.bodies.inertia[k]) / 3);
    }
    mass = communicator.max(mass), inertia = communicator.max(inertia);
    double const by_force = std::max(norm(gravity), ratio(largest(force), mass));
    double const by_torque = std::max(ratio(by_force, reach), ratio(largest(torque), inertia));
    double const turning = ratio(largest(change_of_alpha), std::max(largest(alpha), by_torque));
    double const linear =
        ratio(largest(change_of_acceleration), std::max(largest(acceleration), by_force));
    return larger(turning, linear);
}

}  // namespace catena
