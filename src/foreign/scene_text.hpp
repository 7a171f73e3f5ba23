// Text of a scene whose chains and forces are those of a System.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "foreign/settings.hpp"

namespace catena::foreign {

/// Holds what the scene's text says. Paths are relative to the working folder.
struct SceneDraft {
    std::string file;  // the scene's own
    std::string title, source, system, topology;
    std::string start;  // file of the start's positions: the folder's topology or State
    std::vector<std::string> leave_out;
    /// Length of the links that replace a force's bonds, nm, as ForceChanges::links.
    std::vector<std::pair<std::string, double>> links;
    bool relax = false;
    std::int64_t steps = 0;
    Settings settings;
};

/// Returns the scene as YAML, with the settings' notes as comments. Its paths are relative to the
/// scene's folder.
std::string text_of(SceneDraft const&);

}  // namespace catena::foreign
