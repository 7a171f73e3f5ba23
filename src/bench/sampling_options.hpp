// The options of `catena bench sampling` on the command line.
#pragma once

#include <string>

#include "console/requests.hpp"

namespace CLI {
class App;
}

namespace catena::command {

/// As they stand there; empty: not given.
struct SamplingOptionTexts {
    std::string scene, copies, methods, steps, duration, discard, every, equilibration, seconds;
};

void add_sampling(CLI::App& bench, SamplingOptionTexts&);

/// InputError for what is no number, out of bounds or unknown, for an option that benchmark `name`
/// has not, and where the file `json` is the scene.
SamplingOptions sampling_options(SamplingOptionTexts const&, std::string const& name,
                                 std::string const& json);

}  // namespace catena::command
