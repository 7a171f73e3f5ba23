// Descriptions of parts of a scene, shared by the commands.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "integrate/step_limit.hpp"
#include "scene/scene.hpp"
#include "terms/force_terms.hpp"

namespace catena::command {

/// Returns "title (file)".
std::string title_of(Scene const&);
/// Returns a table of the chains; equal neighbouring chains share one row.
Table chain_table(Scene const&);
/// Returns [{"name", "bodies", "kind", "base"}] for every chain, with "tip" if the tip is jointed.
Json chains_json(Scene const&);

/// Numbers of joints, bodies or beads on which each force term acts (terms::counts()), and of
/// joints with prescribed motion, which follow the terms on joints.
std::vector<terms::TermCount> loads_of(Scene const&);
/// Returns for example "springs on 2 joints, ..."; "none" if nothing acts.
std::string loads_text(Scene const&);

/// Returns for example "g-baoab, 5000 steps of 0.01 ps (50 ps), ...".
std::string dynamics_text(Scene const&);
/// Unit of time of the scene: "ps" or "s".
char const* time_unit(Scene const&);
/// Unit of energy of the scene: "kJ/mol" or "J".
char const* energy_unit(Scene const&);

/// Number of directions that a handle carries: one number for chains of links, one for all body
/// chains of the scene; 0 if the scene has none.
struct Directions {
    int beads = 0, bodies = 0;
};
Directions directions_of(Scene const&);
/// Returns for example "5x5, projected on the restricted directions of revolute joints".
std::string block_text(bool beads, int directions, Handles);

/// Returns the remarks that `check` and `plan` print below the numbers: the reader's notes, output
/// that a run would write too rarely, and a time step close to its limit. Throws InputError for a
/// time step beyond the limit.
std::vector<std::string> notes_on(Scene const&, std::optional<StepLimit> const&);

/// Returns solver.gpu_levels if the backend is cuda-levels ("all" for auto), else null.
Json gpu_levels_json(Scene const&);

/// Estimated bytes per rank, computed from array sizes for the largest share. OpenMM is not
/// included.
struct Memory {
    double scene = 0, state = 0, solver = 0;
    double sum() const { return scene + state + solver; }
};
/// Estimates the memory of the scene on the given number of ranks.
Memory memory_of(Scene const&, int ranks);

}  // namespace catena::command
