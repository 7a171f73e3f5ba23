// Options of `catena bench sampling` on the command line.
#pragma once

#include <string>

#include "console/command_parser.hpp"
#include "console/requests.hpp"

namespace catena::command {

/// Texts of the options; empty if not given. `dense`: the flag is given.
struct SamplingOptionTexts {
    std::string scene, copies, methods, steps, duration, discard, every, equilibration, seconds;
    bool dense = false;
};

/// Adds the options to `catena bench`.
void add_sampling(OptionList& bench, SamplingOptionTexts&);

/// Reads the options. Throws InputError for values that are no number, out of bounds or unknown,
/// for an option that benchmark `name` does not have, and if the file `json` is the scene.
SamplingOptions sampling_options(SamplingOptionTexts const&, std::string const& name,
                                 std::string const& json);

}  // namespace catena::command
