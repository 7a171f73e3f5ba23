// Implements the settings of serialised Integrators and the defaults.
#include "foreign/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "foreign/calvados_folder.hpp"
#include "io/output_file.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

namespace {

/// Value of an attribute in the first tag of an XML text; empty if it has none.
std::string attribute(std::string_view tag, std::string const& name) {
    for (char const quote : {'"', '\''}) {
        std::string const key = " " + name + "=" + quote;
        auto const at = tag.find(key);
        if (at == std::string_view::npos) continue;
        auto const begin = at + key.size();
        return std::string(tag.substr(begin, tag.find(quote, begin) - begin));
    }
    return "";
}

/// Sets `value` to the attribute if it is a number.
bool take(std::string_view tag, char const* name, double& value) {
    return scene::parse_number(attribute(tag, name), value) == scene::NumberFault::none;
}

/// Reads temperature, friction and step of a Langevin integrator, the step of another one.
Settings integrator_settings(std::string const& file) {
    std::string const xml = read_text_file(file);
    auto const begin = xml.find("<Integrator");
    std::string_view const tag =
        std::string_view(xml).substr(std::min(begin, xml.size()), xml.find('>', begin) - begin);
    std::string const type = attribute(tag, "type"),
                      name = scene::shown_path(std::filesystem::path(file).filename().string());
    Settings settings;
    bool const warm = take(tag, "temperature", settings.temperature),
               damped = take(tag, "friction", settings.friction),
               timed = take(tag, "stepSize", settings.step);
    settings.notes.push_back(
        fmt::format("{} ({}): {:.6g} K{}, friction {:.6g}/ps{}, steps of {:.6g} ps{}.", name,
                    type.empty() ? "unknown kind" : scene::shown(type), settings.temperature,
                    warm ? "" : " assumed", settings.friction, damped ? "" : " assumed",
                    settings.step, timed ? "" : " assumed"));
    return settings;
}

}  // namespace

Settings settings_of(Files const& files) {
    if (!files.config.empty()) return calvados_settings(files);
    if (!files.integrator.empty()) return integrator_settings(files.integrator);
    Settings settings;
    settings.notes.push_back(
        fmt::format("No settings of the run were read (config.yaml, one serialised Integrator): "
                    "{:.6g} K, friction {:.6g}/ps and {} steps of {:.6g} ps are assumed.",
                    settings.temperature, settings.friction, settings.steps, settings.step));
    return settings;
}

}  // namespace catena::foreign
