// Report on a scene's start for `check`, `run` and summary.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "start/start_check.hpp"
#include "start/start_relaxation.hpp"

namespace catena {

/// Properties of a start that the report contains.
struct StartReport {
    StartChange change;                         // changes made by the reader
    std::optional<StartForces> forces;          // empty without OpenMM's forces
    std::optional<StartRelaxation> relaxation;  // empty unless the scene requests it
};

/// Names and values of the report's lines.
std::vector<std::pair<std::string, std::string>> lines_of(Scene const&, StartReport const&);
/// Object of summary.json: {"largest_link_change", "link", "largest_displacement", "bead"}. Forces
/// add "potential_energy", "thermal_energy", "temperature", "largest_force", "force_on",
/// "nearest_distance" and "nearest_beads". A relaxation adds "relaxation": {"steps",
/// "largest_displacement", "from", "to"}.
nlohmann::json json_of(StartReport const&);

}  // namespace catena
