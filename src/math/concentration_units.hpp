// Concentrations of what is counted in cubic nanometres. The one home of these factors.
#pragma once

namespace catena {

/// Mass density of 1 amu/nm^3 in mg/ml, which is g/l (CODATA 2022).
constexpr double mg_per_ml = 1.66053906892;
/// Concentration of one molecule per nm^3 in mmol/l, with 1 g/mol for 1 amu, which is true to 1e-9.
constexpr double mmol_per_l = 1e3 * mg_per_ml;

}  // namespace catena
