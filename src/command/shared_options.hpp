// Options that several commands have.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command/command.hpp"
#include "console/option_values.hpp"
#include "error.hpp"

namespace catena::command {

/// Declares the shared options of a command.
void add_shared(OptionList&, CommonOptions&, SharedOptions);
/// Declares --repeat; `otherwise` is the default that help shows.
void add_repeat(OptionList&, std::string& text, std::string const& otherwise);
/// Declares --refine.
void add_refine(OptionList&, CommonOptions&);
/// Declares the argument SCENE.
void add_scene(OptionList&, std::string& text);

/// Returns the common options with all values checked. Throws InputError.
CommonOptions checked(CommonOptions);
/// Returns the value of --repeat, or its default. Throws InputError.
int repeat_of(std::string const& text, int otherwise);
/// Returns the numbers of --sizes; empty if it was not given. Throws InputError.
std::vector<std::int64_t> sizes_of(std::string const& text);

/// Returns a request with the common options checked. Throws InputError.
template <class R>
R common_request(CommonOptions const& common) {
    R request;
    static_cast<CommonOptions&>(request) = checked(common);
    return request;
}
/// Returns a request on one scene with the common options checked. Throws InputError if no scene is
/// named, and if an output file is the scene.
template <class R>
R scene_request(CommonOptions const& common, std::string const& scene, std::string const& command,
                std::string const& accelerations = "") {
    if (scene.empty())
        throw InputError("no scene is named", "command line", "write catena " + command + " SCENE");
    R request = common_request<R>(common);
    request.scene = scene;
    require_files_apart(scene, common.json, accelerations);
    return request;
}

}  // namespace catena::command
