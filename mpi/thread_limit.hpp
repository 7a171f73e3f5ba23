// How many threads a rank may be asked for.
#pragma once

#include <string>

namespace catena {

/// InputError, with `where` (a key of the scene), for more threads than any use has: above 64 and
/// above 16 a processor. Libraries of threads end the process where the system refuses one.
void require_possible_threads(int threads, std::string const& where);

}  // namespace catena
