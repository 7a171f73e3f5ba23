// Draws pictures of a report by a Python script of jobs/ if a Python with matplotlib is found.
#pragma once

#include <string>

namespace catena::command {

/// Runs jobs/report_plot.py, which draws a PNG for each part of the report into the folder. Returns
/// an empty string, or why there is no picture and what to do. Searches Python in VIRTUAL_ENV, in a
/// folder venv of the build tree that contains the program, and on PATH.
std::string draw_report(std::string const& report_json, std::string const& folder);
/// Runs jobs/plot_analysis.py, which draws analysis.png into a folder of tables. Returns an empty
/// text, or why there is no picture and what to do.
std::string draw_analysis(std::string const& folder);

}  // namespace catena::command
