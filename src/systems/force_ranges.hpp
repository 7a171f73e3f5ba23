// How far the particles of a System act on each other. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <cstdint>
#include <vector>

#include "neighbours/pair_ranges.hpp"

namespace catena {

/// Of each of its particles 1 where it acts in the force between pairs, else 0; none of another
/// force. A particle does not act in a CustomNonbondedForce whose energy is zero for its
/// parameters, whatever those of the other are (a product of charges), nor in a NonbondedForce
/// without charge and epsilon.
std::vector<char> acting_particles(OpenMM::Force const&);

/// Of its nonbonded forces, the longest first; none whose particles all act in a longer one.
/// Precondition: every force can be split and has a cutoff. Throws what OpenMM throws where a force
/// has not one particle for each of the System's.
std::vector<PairRange> pair_ranges(OpenMM::System const&,
                                   std::vector<std::int64_t> const& bead_of_particle);

}  // namespace catena
