// The outboard end of a chain: `tip: free | fixed | ring | {joint: {...}} | {ring: {...}}`.
#pragma once

#include "reader/chain_request.hpp"

namespace catena::scene {

struct ReadTip {
    Tip kind = Tip::free;
    TipJoint joint;
    bool bare = false;             // `tip: fixed`, `tip: ring`
    Node const* planar = nullptr;  // a joint that is written `planar`
};
/// What the key says. InputError for joints that are wrong in themselves.
ReadTip read_tip(Fields const& chain);

/// Gives the finished chain its tip: checks that joint and chain go together and that the joint is
/// closed at the start (1e-9 of the chain's reach), sets a link's length. What is open by a little
/// more is closed by the least change of positions: the link of a chain of beads at once, within
/// `largest_link_change`; other joints, within `closable`, by the run's projections, which a note
/// says. InputError names error and remedy.
void join_tip(ChainSpec& chain, ReadTip const& tip, ChainRequest const& request);

}  // namespace catena::scene
