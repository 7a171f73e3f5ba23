// Relaxation of a start (`relax: true`): the scene's own forces separate overlapping beads before
// the first step.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"
#include "start/start_check.hpp"

namespace catena {

/// Result of a relaxation, on rank 0. Other ranks have default values.
struct StartRelaxation {
    std::int64_t steps = 0;  // evaluations of forces
    double moved = 0;        // largest displacement of a bead, nm
    bool at_rest =
        true;  // the energy fell no further; false: the largest number of evaluations was reached
    StartForces from, to;  // forces before and after

    /// Text of way_text() with the forces before and after.
    std::string text() const;
    /// Text of the number of evaluations and the largest displacement, without energies.
    std::string way_text() const;
};

/// Relaxed scene and how the relaxation proceeded.
struct RelaxedScene {
    Scene scene;
    StartRelaxation relaxation;
};

/// Callback for progress on rank 0, one line every few seconds; may be empty.
using RelaxationSays = std::function<void(std::string const&)>;
/// Returns a callback that prints to standard error, or none if `quiet`.
RelaxationSays relaxation_says(bool quiet);

/// Moves beads and rigid domains along OpenMM's forces until the energy falls no further. Steps are
/// limited in length, and the links are closed after each. Forces between near beads act first,
/// then all forces, with at most 3000 evaluations each; large scenes are limited to fewer
/// evaluations of all forces. Rank 0 computes alone, by OpenMM's platform Reference if the scene
/// requests it. Otherwise it uses CPU with one thread, because forces of several threads differ in
/// their last bits from run to run. All ranks receive its positions. Throws InputError if the start
/// remains absurd, for beads on other joints, and without OpenMM's forces. Precondition:
/// scene.relax. Collective.
RelaxedScene relax_start(Scene const&, Communicator const&, RelaxationSays const& = {});

/// Relaxes the start if the scene requests it; else the result is empty. Collective.
std::optional<RelaxedScene> relaxed_where_asked(Scene const&, Communicator const&,
                                                RelaxationSays const& = {});

}  // namespace catena
