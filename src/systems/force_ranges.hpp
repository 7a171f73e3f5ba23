// Cutoffs between the particles of a System and the particles that act. Needs OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <cstdint>
#include <vector>

#include "neighbours/pair_ranges.hpp"

namespace catena {

/// For each particle: 1 if it acts in the pair force, else 0. The list is empty for other forces. A
/// particle does not act in a CustomNonbondedForce if its parameters make the energy zero for any
/// partner (a product of charges). It does not act in a NonbondedForce without charge and epsilon.
std::vector<char> acting_particles(OpenMM::Force const&);

/// Cutoffs of the System's nonbonded forces with their acting beads, the longest first. A range is
/// omitted if all its particles act in a longer one. Precondition: every force can be split and has
/// a cutoff. Throws OpenMM's exception if the number of a force's particles differs from the
/// System's.
std::vector<PairRange> pair_ranges(OpenMM::System const&,
                                   std::vector<std::int64_t> const& bead_of_particle);

}  // namespace catena
