// A System for some particles of another one: what a rank computes. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <memory>
#include <optional>
#include <vector>

namespace catena {

/// Whether forces on some particles can be had without the others: the cutoff kinds of nonbonded forces, all the common bonded ones.
bool can_be_split(OpenMM::Force const&);

/// How far nonbonded forces reach: 0 without any, infinite where one has no cutoff. Precondition: every force can be split.
double reach_of(OpenMM::System const&);

/// Particles, ascending, that share a bonded term or an exception with one of `own` and are not among them.
std::vector<int> bonded_partners(OpenMM::System const&, std::vector<int> const& own);

/// The System of `particles`, in this order, with the forces that act on the first `own_count` of them complete: bonded terms that touch
/// one of these, and all pairs. Force groups and names stay. Precondition: what shares a bonded term with them is among `particles`.
std::unique_ptr<OpenMM::System> subset_of(OpenMM::System const&, std::vector<int> const& particles, int own_count);

}  // namespace catena
