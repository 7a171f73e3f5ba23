// Comparison of a checkpoint with a scene: same scene, or a list of differing values for a branch.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io/output.hpp"
#include "terms/deciding.hpp"

namespace catena {

/// Stores the scene's values in the notes of a checkpoint, as the text of a JSON object.
void keep_values(Scene const&, std::map<std::string, std::string>& notes);

/// Throws InputError, which names the first differing value, if the checkpoint `file` belongs to
/// another scene.
void require_own(Checkpoint const&, Scene const&, std::string const& file);

/// Returns the values that a branch from the checkpoint changes. Throws InputError if such a branch
/// is impossible: other bodies, units or kind of coordinates.
std::vector<scene::ChangedValue> branch_changes(Checkpoint const&, Scene const&,
                                                std::string const& file);

/// One sentence for the summary: "branched at step 100 from out/checkpoint.h5: dynamics.temperature
/// 300 -> 310; the verdict covers the branch only".
std::string note_of_branch(std::string const& file, std::int64_t step,
                           std::vector<scene::ChangedValue> const&);
/// Object of summary.json: {"from", "step", "changes": [{"key", "before", "now"}]}.
nlohmann::json json_of_branch(std::string const& file, std::int64_t step,
                              std::vector<scene::ChangedValue> const&);

}  // namespace catena
