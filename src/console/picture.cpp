// Implements the drawing of a report's pictures by jobs/report_plot.py.
#include "console/picture.hpp"

#include "console/helper_programs.hpp"

namespace catena::command {

std::string draw_report(std::string const& report_json, std::string const& folder) {
    auto const script = find_in_source_tree("jobs/report_plot.py");
    if (!script)
        return "no picture: jobs/report_plot.py was not found near this program; run it from the "
               "source tree on " +
               report_json;
    auto const python = find_python("matplotlib");
    std::string const words = script->string() + " " + report_json + " " + folder;
    if (!python)
        return "no picture: no Python with matplotlib was found; with one, run: python3 " + words;
    if (run_quietly({*python, script->string(), report_json, folder}) != 0)
        return "no picture: the script failed; run it to see why: " + *python + " " + words;
    return "";
}

}  // namespace catena::command
