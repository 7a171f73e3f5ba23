// Times of the parts of a step in absolute coordinates that single evaluations do not show. Steps
// are measured as the integrator makes them.
#pragma once

#include "plan/phases.hpp"

namespace catena::plan {

/// Parts of a step. `drift`: one drift with its matrix sweep, the chains' own forces and the kick,
/// without projection sweeps; `closing`: one projection sweep; `noise`: the noise of the
/// thermostat.
enum DriftCost : std::size_t { drift, closing, noise, drift_costs };
/// Seconds of each part.
using DriftSeconds = std::array<double, drift_costs>;
/// Seconds of each part as functions of the number of bodies.
using DriftCurve = Curve<drift_costs>;

/// Returns the shortest of several times for each part; the chains hardly move. Precondition: the
/// system is in absolute coordinates. Collective.
DriftSeconds measure_drifts(ChainSystem&, Effort const& = {});

}  // namespace catena::plan
