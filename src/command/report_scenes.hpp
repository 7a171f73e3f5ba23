// The scenes of `catena report`.
#pragma once

#include "command/commands.hpp"

namespace catena::command {

/// Those of a report on no scenes of the user's; with `quick` fewer and smaller ones.
ReportScenes generated_report(ReportRequest const&);

/// All for the solver; with `dynamics` and no OpenMM for the integrators, with OpenMM for the
/// forces.
ReportScenes sorted_for_report(std::vector<Scene>);

}  // namespace catena::command
