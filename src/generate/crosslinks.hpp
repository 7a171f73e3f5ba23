// Cross-links at the start of a chain of point beads: their lengths, which of them are independent,
// and the changes of positions that close them.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Returns the number of links of the chain, cross-links included, that keep their lengths at its
/// positions because the others do: ChainSpec::redundant_links.
std::int64_t redundant_links(ChainSpec const&);

/// Moves beads so that all links of the chain have their lengths, by the least change of positions.
/// Returns false if that fails; the positions then have no meaning.
bool project_links(ChainSpec const&, std::vector<Vec3>& positions);

/// Ends of notes on how cross-links change a start, which other positions take back.
inline constexpr char const *closing_note = "to close cross-links",
                            *special_note = "give positions that are not so special";

/// Permissions of fit_crosslinks(), and the scene that takes its notes.
struct CrossLinkFit {
    Scene& scene;
    /// The value in the scene, for messages.
    Node const& from;
    /// True if positions are generated, so that beads may move far.
    bool far = false;
    /// True if nothing is noted, as for further copies of a chain.
    bool quiet = false;
    /// True if the links that are redundant in any position of such a chain have been noted.
    bool is_known = false;
    /// Remedy if the positions do not fit the lengths.
    char const* remedy = "write `relax: true`, give positions that fit, or leave the length out";
};
/// Gives cross-links without a length, those of length 0, the distance of their beads. Moves the
/// beads where others have another length, and sets ChainSpec::redundant_links. Throws InputError
/// if a cross-link would change by more than largest_link_change, unless that is permitted, or
/// cannot be closed.
void fit_crosslinks(ChainSpec&, CrossLinkFit const&);

}  // namespace catena::scene
