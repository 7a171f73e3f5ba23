// Builds the parts of `catena report` from measurements.
#pragma once

#include "measure/force_errors.hpp"
#include "measure/integrator_errors.hpp"
#include "measure/solver_errors.hpp"
#include "measure/stability.hpp"
#include "report/report_part.hpp"

namespace catena::command {

/// Returns the part on the solver's errors against its run time.
ReportPart solver_part(std::vector<SolverStudy> const&);
/// Returns the part on the integrators' errors; `drifts` may be empty.
ReportPart integrator_part(std::vector<IntegratorStudy> const&,
                           std::vector<DriftStudy> const& drifts);
/// Returns the part on the errors of OpenMM's forces.
ReportPart force_part(std::vector<ForceStudy> const&);
/// Returns the part on the stability suite.
ReportPart stability_part(std::vector<StabilityStudy> const&);
/// Returns the part on the stability suite in other programs. `peers` holds their names and
/// versions, or why they are missing.
ReportPart peers_part(std::vector<StabilityStudy> const&, Json peers);

}  // namespace catena::command
