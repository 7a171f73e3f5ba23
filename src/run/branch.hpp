// Whether a checkpoint is one of a scene's, and what differs where it is not.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io/output.hpp"
#include "scene/deciding.hpp"

namespace catena {

/// Keeps the scene's values in the notes of a checkpoint, as the text of a JSON object.
void keep_values(Scene const&, std::map<std::string, std::string>& notes);

/// Throws InputError, which names the first value that differs, where the checkpoint `file` belongs
/// to another scene.
void require_own(Checkpoint const&, Scene const&, std::string const& file);

/// What a branch from the checkpoint changes. Throws InputError where that cannot be: other bodies,
/// units or kind of coordinates.
std::vector<scene::ChangedValue> branch_changes(Checkpoint const&, Scene const&,
                                                std::string const& file);

/// One sentence: "branched at step 100 from out/checkpoint.h5: dynamics.temperature 300 -> 310; the
/// verdict covers the branch alone".
std::string note_of_branch(std::string const& file, std::int64_t step,
                           std::vector<scene::ChangedValue> const&);
nlohmann::json json_of_branch(std::string const& file, std::int64_t step,
                              std::vector<scene::ChangedValue> const&);

}  // namespace catena
