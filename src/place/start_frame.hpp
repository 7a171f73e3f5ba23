// Start from a frame of another run: `start: {from: FOLDER, frame: last}`.
#pragma once

#include <vector>

#include "place/draft.hpp"

namespace catena::scene {

/// Puts all drafts where the frame that `start` names has them. Wrapped chains are made whole along
/// their links; links get their lengths by the least change; rigid domains keep their shape. If the
/// scene's box differs from the frame's, free chains are brought into the frame's box as wholes and
/// that box into the middle of the scene's. Velocities are thermal if `warm`, else zero, or as
/// `velocities` says. Notes say what was done. Throws InputError if numbers of chains or beads or
/// names of residues differ, with both of them, and for chains of bodies on joints.
void start_from_frame(std::vector<Draft>& drafts, Scene& scene, Node const& start, bool warm);

}  // namespace catena::scene
