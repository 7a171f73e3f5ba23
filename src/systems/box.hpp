// Checks of periodic boxes and cutoffs for OpenMM. Needs OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <string>

namespace catena {

/// Throws InputError for a periodic box with far too many cutoffs along two of its edges. The cells
/// of OpenMM's neighbour lists would take gigabytes, or their number overflow. OpenMM throws that
/// error in its own threads, where it cannot be caught. `where` is the place in the message.
void refuse_box_beyond_cutoffs(OpenMM::System const& system, std::string const& where);

}  // namespace catena
