// What was measured on a machine so far.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "plan/drift_costs.hpp"
#include "plan/level_costs.hpp"

namespace catena::plan {

/// Where a level of merges is computed.
enum class Place { host, gpu };

class Calibration {
  public:
    PhaseCurve& of(Family const&, Arrangement const&);
    DriftCurve& of_drifts(Family const&, Arrangement const&);
    LevelCurve& of(Family const&, Place, int threads);
    /// Points of all curves.
    std::size_t points() const;

    nlohmann::json json() const;
    /// Adds what json() gave; throws where it is something else, times that cannot be included.
    void read(nlohmann::json const&);

  private:
    std::map<std::string, PhaseCurve> phases_;
    std::map<std::string, DriftCurve> drifts_;
    std::map<std::string, LevelCurve> levels_;
};

}  // namespace catena::plan
