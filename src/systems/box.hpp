// Boxes that OpenMM cannot compute in. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <string>

namespace catena {

/// Throws InputError where two edges of the System's periodic box are so many cutoffs long that the
/// cells of OpenMM's neighbour lists take gigabytes, or their number runs over: OpenMM throws that
/// in threads of its own, where nobody can catch it. `where`: for the message.
void refuse_box_beyond_cutoffs(OpenMM::System const& system, std::string const& where);

/// Pair forces with a cutoff beyond `reach` (nm) end there, switched off from 0.8 of it on.
void shorten_pair_forces(OpenMM::System&, double reach);

}  // namespace catena
