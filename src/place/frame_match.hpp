// Comparison of a frame of another run with the chains that start from it.
#pragma once

#include <vector>

#include "frames/chosen_frame.hpp"
#include "place/draft.hpp"

namespace catena::scene {

/// Throws InputError unless the frame has beads for every chain of the scene: the same numbers of
/// chains and beads, branches and residues, in the same units. Notes chains with other names or
/// cross-links. `start` is the scene's section, `from` names the frame.
void refuse_frame_of_others(ChosenFrame const&, std::vector<Draft> const&, Scene&,
                            Node const& start, Node const& from);

}  // namespace catena::scene
