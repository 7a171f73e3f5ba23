// The options of `catena import` on the command line.
#pragma once

#include <string>
#include <vector>

#include "console/requests.hpp"

namespace CLI {
class App;
}

namespace catena::command {

/// Options as they stand on the command line. An empty text was not given.
struct ImportOptionTexts {
    std::string source, topology, output, leave_out;
    std::vector<std::string> links;
    bool overwrite = false;
};

/// Adds the command and returns it, without the options that all commands have.
CLI::App* add_import(CLI::App& app, ImportOptionTexts&);

/// Returns the request. Throws InputError for a missing source and for links without a length.
ImportRequest import_request(ImportOptionTexts const&, CommonOptions const&);

}  // namespace catena::command
