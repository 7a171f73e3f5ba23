// Parses the command line and explains it (--help).
#pragma once

#include "console/requests.hpp"

namespace catena::command {

/// Returns the request on the command line. Throws InputError with one line for anything that is
/// not understood, and "not in this version" for what is planned.
Request parse_command_line(int argc, char const* const* argv);

}  // namespace catena::command
