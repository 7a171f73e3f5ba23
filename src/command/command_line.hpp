// The command line: what may be asked, and how it is explained.
#pragma once

#include "console/requests.hpp"

namespace catena::command {

/// Throws InputError with one line for whatever is not understood; `not in this version` for what
/// the contract promises later.
Request parse_command_line(int argc, char const* const* argv);

}  // namespace catena::command
