// Readers of the sections of a scene other than its chains.
#pragma once

#include "place/concentration.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"
#include "structure/calvados2.hpp"

namespace catena::scene {

/// Reads `cubic` of `box`: the concentration that decides the edges.
Concentration read_cubic(Node const& cubic);
/// Reads `box`: edges of the periodic box, or none, also for a `cubic` one. Throws InputError for
/// edges that are not positive or that a double cannot resolve.
std::optional<Vec3> read_box(Node const& box);
/// Reads `dynamics`. `si` is true for SI units, which require a friction for Langevin integrators.
DynamicsSpec read_dynamics(Node const& dynamics, bool si);
/// Reads `forces`. `dynamics` may be nullptr; its temperature is the default of the force field.
/// `file` is the scene's file, for relative paths.
ForceSpec read_forces(Node const& forces, Node const* dynamics, bool si, std::string const& file);
/// Reads `charge_termini`: both, N, C or none.
calvados2::ChargedTermini read_charged_termini(Node const&);
/// Returns the flags in the form of OpenMmSpec::map.
inline std::pair<std::int64_t, std::int64_t> as_numbers(calvados2::ChargedTermini ends) {
    return {ends.n ? 1 : 0, ends.c ? 1 : 0};
}
/// Reads `solver`. The choice of a backend for `auto` is left to the planner.
SolverSpec read_solver(Node const& solver);
/// Reads `output`. Throws InputError for unknown or repeated observables.
OutputSpec read_output(Node const& output);

}  // namespace catena::scene
