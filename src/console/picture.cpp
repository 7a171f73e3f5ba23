// Implements the drawing of a report's pictures by jobs/report_plot.py.
#include "console/picture.hpp"

#include <vector>

#include "console/helper_programs.hpp"

namespace catena::command {

namespace {

/// Runs a script of jobs/ on `words`. Returns an empty text, or why there is no picture.
std::string draw(std::string const& name, std::vector<std::string> const& words) {
    std::string of;
    for (std::string const& word : words) of += " " + word;
    auto const script = find_in_source_tree("jobs/" + name);
    if (!script)
        return "no picture: jobs/" + name +
               " was not found near this program; run it from the source tree on" + of;
    auto const python = find_python("matplotlib");
    if (!python)
        return "no picture: no Python with matplotlib was found; with one, run: python3 " +
               script->string() + of;
    std::vector<std::string> command{*python, script->string()};
    command.insert(command.end(), words.begin(), words.end());
    if (run_quietly(command) != 0)
        return "no picture: the script failed; run it to see why: " + *python + " " +
               script->string() + of;
    return "";
}

}  // namespace

std::string draw_report(std::string const& report_json, std::string const& folder) {
    return draw("report_plot.py", {report_json, folder});
}

std::string draw_analysis(std::string const& folder) { return draw("plot_analysis.py", {folder}); }

}  // namespace catena::command
