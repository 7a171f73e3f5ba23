// What `check`, `run` and summary.json say of a scene's start.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "start/start_check.hpp"
#include "start/start_relaxation.hpp"

namespace catena {

struct StartReport {
    StartChange change;                         // made by the reader
    std::optional<StartForces> forces;          // with OpenMM's forces
    std::optional<StartRelaxation> relaxation;  // where the scene asked for it
};

/// Names and values of lines.
std::vector<std::pair<std::string, std::string>> lines_of(Scene const&, StartReport const&);
/// {"largest_link_change", "link", "largest_displacement", "bead"; with forces "potential_energy",
/// "thermal_energy", "temperature", "largest_force", "force_on", "nearest_distance",
/// "nearest_beads"; with relaxation "relaxation": {"steps", "largest_displacement", "from", "to"}}.
nlohmann::json json_of(StartReport const&);

}  // namespace catena
