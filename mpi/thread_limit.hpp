// Limit on the number of threads per rank.
#pragma once

#include <string>

namespace catena {

/// Throws InputError with `where` (a key of the scene) for an implausible number of threads: above
/// 64 and above 16 per processor. Thread libraries terminate the process if the system refuses a
/// thread.
void require_possible_threads(int threads, std::string const& where);

}  // namespace catena
