// The parts of `catena report`, from what was measured.
#pragma once

#include "measure/force_errors.hpp"
#include "measure/integrator_errors.hpp"
#include "measure/solver_errors.hpp"
#include "measure/stability.hpp"
#include "report/report_part.hpp"

namespace catena::command {

ReportPart solver_part(std::vector<SolverStudy> const&);
/// `drifts` may be empty.
ReportPart integrator_part(std::vector<IntegratorStudy> const&,
                           std::vector<DriftStudy> const& drifts);
ReportPart force_part(std::vector<ForceStudy> const&);
ReportPart stability_part(std::vector<StabilityStudy> const&);
/// The same cases by other programs; `peers`: their names and versions, or why they are missing.
ReportPart peers_part(std::vector<StabilityStudy> const&, Json peers);

}  // namespace catena::command
