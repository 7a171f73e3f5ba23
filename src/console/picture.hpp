// Pictures are drawn by a Python script of jobs/, where there is a Python with matplotlib.
#pragma once

#include <string>

namespace catena::command {

/// Runs jobs/report_plot.py, which draws a PNG for each part of the report into the folder. Empty,
/// or why not and what to do. Looks for Python in VIRTUAL_ENV, in a folder venv of the build tree
/// the program lies in, and on PATH.
std::string draw_report(std::string const& report_json, std::string const& folder);

}  // namespace catena::command
