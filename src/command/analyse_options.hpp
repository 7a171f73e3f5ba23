// The options of `catena analyse` and `catena convert` on the command line.
#pragma once

#include <string>
#include <vector>

#include "console/requests.hpp"

namespace CLI {
class App;
}

namespace catena::command {

/// Options as they stand on the command line. An empty text was not given.
struct AnalyseOptionTexts {
    std::string folder, output, first, last, discard, cutoff, fit, slab, bins;
    std::string file, wrap;
};

/// Adds both commands and returns them, without the options that all commands have.
std::vector<CLI::App*> add_trajectory_commands(CLI::App& app, AnalyseOptionTexts&);

/// Return the requests. Throw InputError for what is missing, no number, out of bounds or unknown.
AnalyseRequest analyse_request(AnalyseOptionTexts const&, CommonOptions const&);
ConvertRequest convert_request(AnalyseOptionTexts const&, CommonOptions const&);

}  // namespace catena::command
