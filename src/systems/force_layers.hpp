// Layers of a System: long-range pair forces that act on few of its particles, in a System of their
// own. A Context searches for pairs among all of its particles up to the longest cutoff of its
// forces. In CALVADOS 2 that is 4 nm for the charges, which a quarter of the beads have. All other
// forces have a cutoff of 2 nm, within which lie an eighth of the pairs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "systems/bead_system.hpp"
#include "systems/model.hpp"

namespace catena {

/// A System of some forces on some of the beads.
struct ForceLayer {
    /// Model of these forces alone, in their original groups.
    OpenMmModel model;
    /// Beads that act in these forces. Other members of BeadSystem are set as far as the division
    /// among ranks needs them.
    BeadSystem beads;
    /// Number in the scene of each of these beads, ascending.
    std::vector<std::int64_t> bead;
};

/// Moves forces from `model` into layers, the longest cutoff first. It does so as long as all
/// Contexts together have fewer pairs, and at most `most_pairs` times the pairs of a single
/// Context. Eligible are CustomNonbondedForces with a cutoff, for all pairs (no interaction
/// groups), without a long-range correction of the energy. Forces in which no bead acts are removed
/// without a layer. Returns no layers if any force cannot be split. The result is identical on
/// every rank.
std::vector<ForceLayer> take_layers(OpenMmModel& model, BeadSystem const& beads, double most_pairs);

/// Joins the beads of each chain in the layer by bonds without energy. On GPUs OpenMM lets bonded
/// particles stay together and sorts identical molecules by place, for short lists of pairs.
/// Without these bonds most beads of a layer would be molecules of their own.
void hold_chains_together(ForceLayer&);

/// For each of a rank's beads in a layer: its index among all of the rank's beads, in the order of
/// BeadSystem::by_rank.
std::vector<std::int64_t> own_places(ForceLayer const&, BeadSystem const& all, int rank);

/// For each particle of a layer: the particle of `model`, from which the layer was taken, that is
/// the same bead.
std::vector<int> particles_in(ForceLayer const&, OpenMmModel const& model);

/// Returns, e.g., "yukawa in a Context of its own: it acts on 2500 of 10000 beads, up to 4 nm".
std::string text_of(ForceLayer const&, BeadSystem const& all);

}  // namespace catena
