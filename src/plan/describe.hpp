// Parts of a scene in words, shared by the commands.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "integrate/step_limit.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// "title (file)"
std::string title_of(Scene const&);
/// Equal neighbouring chains in one row.
Table chain_table(Scene const&);
/// [{"name", "bodies", "kind", "base"}], every chain; "tip" where it is jointed.
Json chains_json(Scene const&);

/// What acts on the chains.
struct ForcesOnJoints {
    std::int64_t springs = 0, dampers = 0, torques = 0, motions = 0, wrenches = 0,
                 drag = 0;  // joints (bodies) that have one
};
ForcesOnJoints forces_on_joints(Scene const&);
/// "springs on 2 joints, ..."; "none"
std::string forces_text(ForcesOnJoints const&);
std::string vector_text(Vec3 const&);

/// "g-baoab, 5000 steps of 0.01 ps (50 ps), ..."
std::string dynamics_text(Scene const&);
char const* time_unit(Scene const&);
char const* energy_unit(Scene const&);

/// Directions that a handle carries: those of chains of links, and of the scene's body chains
/// together (0 where there are none).
struct Directions {
    int beads = 0, bodies = 0;
};
Directions directions_of(Scene const&);
/// "5x5, projected on the restricted directions of revolute joints"
std::string block_text(bool beads, int directions, Handles);

/// What `check` and `plan` say of a scene beside its numbers: the reader's notes, what a run would
/// write too seldom, and a step that is near its limit. InputError for a step beyond it.
std::vector<std::string> notes_on(Scene const&, std::optional<StepLimit> const&);

/// solver.gpu_levels with cuda-levels ("all" for auto), else null.
Json gpu_levels_json(Scene const&);

/// Bytes a rank needs, by the sizes of the arrays. An estimate: the largest share, OpenMM not
/// counted.
struct Memory {
    double scene = 0, state = 0, solver = 0;
    double sum() const { return scene + state + solver; }
};
Memory memory_of(Scene const&, int ranks);

}  // namespace catena::command
