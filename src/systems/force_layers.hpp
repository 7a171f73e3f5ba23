// Layers of a System: pair forces that reach far and act on few of its particles in a System of
// their own.
//
// A Context looks for pairs among all of its particles as far out as the longest of its forces
// reaches. Of CALVADOS 2 that is 4 nm for the charges, a quarter of the beads; all others reach 2
// nm, where an eighth of the pairs are.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "systems/bead_system.hpp"
#include "systems/model.hpp"

namespace catena {

struct ForceLayer {
    OpenMmModel model;  // of these forces alone, in the groups they had
    BeadSystem
        beads;  // that act in them; of the rest of BeadSystem what ranks' shares are made from
    std::vector<std::int64_t> bead;  // of the scene, of each of these, ascending
};

/// Takes forces off `model`, the longest first, as long as all Contexts together have fewer pairs,
/// and no more than `most_pairs` of those of one: CustomNonbondedForces with a cutoff that ask for
/// all pairs (no interaction groups) and for nothing beyond it (no correction of the energy). Those
/// in which no bead acts get no layer. None where a force cannot be split. The same on every rank.
std::vector<ForceLayer> take_layers(OpenMmModel& model, BeadSystem const& beads, double most_pairs);

/// Of each of a rank's own beads in a layer, its place among all of the rank's, in the order of
/// BeadSystem::by_rank.
std::vector<std::int64_t> own_places(ForceLayer const&, BeadSystem const& all, int rank);

/// "yukawa in a Context of its own: 2500 of 10000 beads act in it, up to 4 nm"
std::string text_of(ForceLayer const&, BeadSystem const& all);

}  // namespace catena
