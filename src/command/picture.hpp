// Pictures are drawn by a Python script of jobs/, where there is a Python with matplotlib.
#pragma once

#include <string>

namespace catena::command {

struct Picture {
    std::string file;    // empty: none was drawn
    std::string remark;  // why not, and what to do
};
/// Runs jobs/report_plot.py. Looks for Python in VIRTUAL_ENV, in the venv folder of the build tree the program lies in, and on PATH.
Picture draw_report(std::string const& report_json, std::string const& png);

}  // namespace catena::command
