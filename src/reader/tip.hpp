// Reader of the outboard end of a chain: `tip: free | fixed | ring | {joint: {...}} | {ring:
// {...}}`.
#pragma once

#include "reader/chain_request.hpp"

namespace catena::scene {

/// Tip as read, before it is joined to the chain. Copies of a chain share it.
struct ReadTip {
    /// Free without the key `tip`.
    Tip kind = Tip::free;
    /// Joint of the tip; its type is a link or a weld for bare tips.
    TipJoint joint;
    bool bare = false;  // `tip: fixed` or `tip: ring`, without a joint
    /// Joint that is written `planar`, or nullptr.
    Node const* planar = nullptr;
};
/// Reads the key `tip`. Throws InputError for invalid joints.
ReadTip read_tip(Fields const& chain);

/// Joins the tip to the finished chain and sets a link's length. Checks that joint and chain are
/// compatible, and that the joint is closed at the start (1e-9 of the chain's reach). A slightly
/// wider opening is closed by the least change of positions. The link of a chain of beads is closed
/// at once, within `largest_link_change`. Other joints are closed within `closable` by the run's
/// constraint projection, with a note. Throws InputError that names error and remedy.
void join_tip(ChainSpec& chain, ReadTip const& tip, ChainRequest const& request);

/// Notes given rates of joints in a loop that has no degrees of freedom.
void note_lost_rates(ChainSpec const& chain, ChainRequest const& request);

}  // namespace catena::scene
