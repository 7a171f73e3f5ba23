// `relax: true`: overlaps of a scene's start are pushed apart by its own forces before the first
// step.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"
#include "start/start_check.hpp"

namespace catena {

struct StartRelaxation {
    std::int64_t steps = 0;  // evaluations of forces
    double moved = 0;        // nm: largest displacement of a bead
    bool at_rest = true;   // the energy fell no further; else it ended after as many evaluations as
                           // it takes at most
    StartForces from, to;  // on rank 0; of the others the energies alone

    std::string text() const;
    /// How it went, without energies.
    std::string way_text() const;
};

struct RelaxedScene {
    Scene scene;
    StartRelaxation relaxation;
};

/// Hears of progress on rank 0, a line every few seconds; may be empty.
using RelaxationSays = std::function<void(std::string const&)>;
/// To standard error; nothing where `quiet`.
RelaxationSays relaxation_says(bool quiet);

/// The scene with beads and rigid domains moved down OpenMM's forces, in steps with a cap, links
/// closed after each, until the energy falls no further: by forces between near beads, then by all;
/// at most 3000 evaluations of each, of all in large scenes fewer. Rank 0 computes, on its own, on
/// OpenMM's platform Reference where the scene asks for it, else CPU with a number of threads that
/// does not depend on ranks: all ranks get its positions. InputError where the start stays absurd,
/// for beads on other joints, and without OpenMM's forces. Precondition: scene.relax. Collective.
RelaxedScene relax_start(Scene const&, Communicator const&, RelaxationSays const& = {});

/// The same where the scene asks for relaxation; nothing where it does not.
std::optional<RelaxedScene> relaxed_where_asked(Scene const&, Communicator const&,
                                                RelaxationSays const& = {});

}  // namespace catena
