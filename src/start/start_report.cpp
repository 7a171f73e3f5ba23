// Implements the report on a scene's start.
#include "start/start_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace catena {
namespace {

using nlohmann::json;

json json_of(StartForces const& found) {
    json forces{{"potential_energy", found.energy},
                {"thermal_energy", found.thermal},
                {"temperature", found.temperature},
                {"largest_force", found.largest_force},
                {"force_on", found.force_at}};
    if (found.nearest >= 0)
        forces.update({{"nearest_distance", found.nearest}, {"nearest_beads", found.nearest_pair}});
    return forces;
}

std::string change_text(double change, char const* unit, std::string const& at) {
    return at.empty() ? "none" : fmt::format("{:.3g} {} ({})", change, unit, at);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> lines_of(Scene const& scene,
                                                          StartReport const& report) {
    char const* const unit = scene.si ? "m" : "nm";
    std::vector<std::pair<std::string, std::string>> lines{
        {"largest link change", change_text(report.change.link, unit, report.change.link_at)},
        {"largest displacement",
         change_text(report.change.position, unit, report.change.moved_at)}};
    if (report.relaxation) {
        lines.emplace_back("relaxation", report.relaxation->way_text());
        lines.emplace_back("energy before", report.relaxation->from.text());
    }
    if (report.forces)
        lines.emplace_back(report.relaxation ? "energy after" : "energy", report.forces->text());
    return lines;
}

json json_of(StartReport const& report) {
    StartChange const& change = report.change;
    json made{{"largest_link_change", change.link},
              {"link", change.link_at},
              {"largest_displacement", change.position},
              {"bead", change.moved_at}};
    if (report.forces) made.update(json_of(*report.forces));
    if (report.relaxation)
        made["relaxation"] = {{"steps", report.relaxation->steps},
                              {"largest_displacement", report.relaxation->moved},
                              {"from", json_of(report.relaxation->from)},
                              {"to", json_of(report.relaxation->to)}};
    return made;
}

}  // namespace catena
