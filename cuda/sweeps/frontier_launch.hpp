// When one launch turns what a rank has of a shared tree and the top above it.
#pragma once

namespace catena::cuda {

/// Whether a rank's `own` tree ends in one block and the `top`, which all ranks share, is one as
/// well: the same block can do both.
/// (`Launches`: as StageWalk or ScanWalk wants them.)
template <class Launches>
bool turns_in_a_block(Launches const& own, Launches const& top) {
    return own.stages() > 0 && own.blocks(own.stages() - 1) == 1 && top.stages() == 1 &&
           top.blocks(0) == 1;
}

}  // namespace catena::cuda
