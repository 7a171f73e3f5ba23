// What a step of chains in absolute coordinates takes beyond single evaluations: steps as the
// integrator takes them.
#pragma once

#include "plan/phases.hpp"

namespace catena::plan {

/// `drift`: with its matrices, forces of the chains themselves and kick, without sweeps; `closing`:
/// one of these; `noise`: a thermostat's.
enum DriftCost : std::size_t { drift, closing, noise, drift_costs };
using DriftSeconds = std::array<double, drift_costs>;
using DriftCurve = Curve<drift_costs>;

/// The shortest of several each. The chains hardly move. Precondition: they are in absolute
/// coordinates. Collective.
DriftSeconds measure_drifts(ChainSystem&, Effort const& = {});

}  // namespace catena::plan
