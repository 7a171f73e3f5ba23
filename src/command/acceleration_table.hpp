// The first bodies' accelerations for the terminal.
#pragma once

#include "console/text.hpp"
#include "measure/solution.hpp"

namespace catena::command {

/// Adds a table with the accelerations of the first bodies in the scene's units, and the number of
/// the others with the way to see them. A solution without arrays becomes one line.
void add_accelerations(Text&, Scene const&, Solution const&);

}  // namespace catena::command
