// Chooses the scenes of `catena report`.
#pragma once

#include "command/commands.hpp"

namespace catena::command {

/// Returns the generated scenes of a report without scenes of the user; fewer and smaller ones with
/// `quick`.
ReportScenes generated_report(ReportRequest const&);

/// Sorts the user's scenes. All are for the solver, those with `dynamics` and no OpenMM for the
/// integrators, those with OpenMM for the forces.
ReportScenes sorted_for_report(std::vector<Scene>);

}  // namespace catena::command
