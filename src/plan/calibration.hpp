// Times that were measured on one machine so far.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "plan/drift_costs.hpp"
#include "plan/level_costs.hpp"

namespace catena::plan {

/// The processor or device that computes a level of merges.
enum class Place { host, gpu };

/// Measured curves by family and arrangement, or by family and place. Asking for an unknown curve
/// creates an empty one.
class Calibration {
  public:
    /// Seconds of the phases of an evaluation.
    PhaseCurve& of(Family const&, Arrangement const&);
    /// Seconds of the parts of a constrained step.
    DriftCurve& of_drifts(Family const&, Arrangement const&);
    /// Seconds of the parts of a level of the pairwise tree.
    LevelCurve& of(Family const&, Place, int threads);
    /// Number of measured points of all curves.
    std::size_t points() const;

    /// Returns all curves as {"phases", "drifts", "levels"}: name to a list of [bodies, seconds].
    nlohmann::json json() const;
    /// Adds the curves that json() returned. Throws an exception if the JSON has another form or
    /// contains times that are negative, not finite or above 1e6 s.
    void read(nlohmann::json const&);

  private:
    std::map<std::string, PhaseCurve> phases_;
    std::map<std::string, DriftCurve> drifts_;
    std::map<std::string, LevelCurve> levels_;
};

}  // namespace catena::plan
