// The sections of a scene beside its chains.
#pragma once

#include "scene/calvados2.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// `box`: edges of the periodic box, or none.
std::optional<Vec3> read_box(Node const& box);
/// `dynamics`; `si`: units of the scene.
DynamicsSpec read_dynamics(Node const& dynamics, bool si);
/// `forces`; `dynamics` may be null: its temperature is the default one of the force field. `file`:
/// the scene's, for relative paths.
ForceSpec read_forces(Node const& forces, Node const* dynamics, bool si, std::string const& file);
/// `charge_termini`: both, N, C or none.
calvados2::ChargedTermini read_charged_termini(Node const&);
/// As OpenMmSpec::map has them.
inline std::pair<std::int64_t, std::int64_t> as_numbers(calvados2::ChargedTermini ends) {
    return {ends.n ? 1 : 0, ends.c ? 1 : 0};
}
SolverSpec read_solver(Node const& solver);
OutputSpec read_output(Node const& output);

}  // namespace catena::scene
