// Functions that all dynamics in absolute coordinates share.
#include "dynamics/absolute_dynamics.hpp"

#include <algorithm>

#include "error.hpp"

namespace catena {

StateArray const& array_named(std::vector<StateArray> const& arrays, std::string const& name) {
    auto const found = std::find_if(arrays.begin(), arrays.end(),
                                    [&](StateArray const& a) { return a.name == name; });
    if (found == arrays.end()) throw ComputationError("the state lacks the array " + name);
    return *found;
}

std::vector<LocalPiece> local_pieces(ChainGroup const& group, Scene const& scene) {
    std::vector<LocalPiece> pieces;
    for (dca::Piece const& piece : group.pieces) {
        ChainSpec const& chain = scene.chains[group.chains[piece.chain].in_scene];
        Vec3 const anchor = group.beads    ? chain.beads.anchor
                            : group.linked ? chain.linked.anchor
                                           : group.joints.translation[piece.local];
        pieces.push_back({piece.local, group.scene_index(piece.local), anchor});
    }
    return pieces;
}

}  // namespace catena
