// Models that the tests of the public headers share.
#pragma once

#include <string>

#include "catena/catena.hpp"

namespace catena::test {

inline Body rod(Triple const& com = {0.5, 0, 0}) {
    return {.mass = 2, .inertia = {{{0.1, 0, 0}, {0, 0.5, 0}, {0, 0, 0.6}}}, .com = com};
}

/// Returns a chain of rods on joints of one type, the first at the ground.
inline Chain rods(Joint joint, int count) {
    Chain chain{.name = "rods", .fixed_base = true};
    for (int k = 0; k < count; ++k) {
        chain.bodies.push_back(rod());
        chain.bodies.back().joint = joint;
        joint.translation = {1, 0, 0};
    }
    return chain;
}
inline Joint revolute() { return {.type = "revolute", .axis = Triple{0, 1, 0}, .q = {0.3}}; }
inline Joint spherical() {
    return {.type = "spherical", .q = {0.8, 0, 0.6, 0}, .qd = {0.3, 0, 0.1}};
}

/// Returns a bent chain of beads with links of length 1.
inline Chain beads(int count) {
    Chain chain{.name = "beads"};
    for (int k = 0; k < count; ++k)
        chain.beads.push_back({.mass = 1.0 + 0.1 * k,
                               .position = {0.8 * k, k % 2 == 0 ? 0.0 : 0.6, 0},
                               .velocity = Triple{0, 0, k % 3 == 0 ? 0.1 : -0.1}});
    return chain;
}

inline Model model_of(Chain const& chain, std::string const& integrator, double step) {
    Model model(Units::si);
    model.add(chain).set("dynamics.integrator", integrator).set("dynamics.step", step);
    return model;
}

}  // namespace catena::test
