// The version of the library that a program is linked with.
#pragma once

#include <string>

namespace catena {

/// Returns the version, such as "0.1.0". It equals `catena_VERSION` of find_package(catena).
std::string version();

}  // namespace catena
