// Summary of a run for the terminal: science first, then the solver.
#pragma once

#include <string>

#include "console/outcome.hpp"

namespace catena::command {

/// Returns the text that `catena run` prints at its end: what was simulated, observables, speed and
/// verdict; then notes, the solver with the reason why it was chosen, and the files. The last line
/// is the verdict again. `summary`: summary.json.
std::string text_of_run(Json const& summary, std::string const& solver_reason);

}  // namespace catena::command
