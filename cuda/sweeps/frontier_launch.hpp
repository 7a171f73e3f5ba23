// Condition under which one launch contains a rank's part of a shared tree and the top above it.
#pragma once

namespace catena::cuda {

/// True if a rank's `own` tree ends in one block and the `top`, which all ranks share, is one block
/// too. The same block can then do both. `Launches` is described at StageWalk and ScanWalk.
template <class Launches>
bool turns_in_a_block(Launches const& own, Launches const& top) {
    return own.stages() > 0 && own.blocks(own.stages() - 1) == 1 && top.stages() == 1 &&
           top.blocks(0) == 1;
}

}  // namespace catena::cuda
