// Implements the settings of serialised Integrators and the defaults.
#include "foreign/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>

#include "error.hpp"
#include "foreign/calvados_folder.hpp"
#include "foreign/known_tools.hpp"
#include "io/output_file.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "systems/xml_scan.hpp"

namespace catena::foreign {

namespace {

/// Attributes of a serialised Integrator.
struct IntegratorTag {
    std::string file;
    std::map<std::string, std::string> attributes;

    [[noreturn]] void refuse(std::string const& what) const {
        throw InputError(what, scene::shown_path(file),
                         "write it with OpenMM's XmlSerializer.serialize(integrator), or move the "
                         "file out of the folder and set the dynamics yourself");
    }
    /// Sets `value` to the attribute, which must not be below `least`. Returns false if there is
    /// none.
    bool take(char const* name, double& value, double least) const {
        auto const written = attributes.find(name);
        if (written == attributes.end()) return false;
        double read = 0;
        if (scene::parse_number(written->second, read) != scene::NumberFault::none ||
            !(read >= least))
            refuse(
                fmt::format("{} of the integrator is `{}`", name, scene::shown(written->second)));
        value = read;
        return true;
    }
};

/// Reads temperature, friction and step of a Langevin integrator, the step of another one. Throws
/// InputError for a file that is damaged or holds something else.
Settings integrator_settings(std::string const& file) {
    std::string const xml = read_text_file(file);
    XmlOutline const outline =
        scan_system_xml(xml, scene::shown_path(file), "settings of the dynamics");
    IntegratorTag const tag{file, outline.attributes};
    if (outline.root != "Integrator" || !outline.type.ends_with("Integrator"))
        tag.refuse("the file holds no serialised Integrator");
    Settings settings;
    Found found{};
    found.temperature = tag.take("temperature", settings.temperature, 0);
    found.friction = tag.take("friction", settings.friction, 0);
    double step = 0;  // it stays 0 for variable steps before the first one
    if (tag.take("stepSize", step, 0) && step > 0) {
        found.step = true;
        settings.step = step;
    }
    settings.notes.push_back(
        settings_note(scene::shown_path(std::filesystem::path(file).filename().string()),
                      scene::shown(outline.type), settings, found));
    if (std::string const more = integrator_note(outline.type, settings); !more.empty())
        settings.notes.push_back(more);
    return settings;
}

}  // namespace

std::string settings_note(std::string const& name, std::string const& kind,
                          Settings const& settings, Found const& found) {
    auto const assumed = [](bool is_read) { return is_read ? "" : " assumed"; };
    return fmt::format("{} ({}): {:.6g} K{}, friction {:.6g}/ps{}, steps of {:.6g} ps{}.", name,
                       kind, settings.temperature, assumed(found.temperature), settings.friction,
                       assumed(found.friction), settings.step, assumed(found.step));
}

std::string integrator_note(std::string const& kind, Settings const& settings) {
    std::string lower = kind;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    auto const is = [&](char const* part) { return lower.find(part) != std::string::npos; };
    if (is("brownian"))
        return fmt::format(
            "Brownian dynamics has no inertia, Catena's has: the scene is Langevin dynamics with "
            "the same friction, {:.6g}/ps, whose motion agrees at times far above {:.3g} ps.",
            settings.friction, settings.friction > 0 ? 1 / settings.friction : HUGE_VAL);
    std::string note;
    if (is("variable"))
        note = fmt::format("The steps of that integrator vary, the scene's are {:.6g} ps.",
                           settings.step);
    if (is("verlet"))
        note += fmt::format(
            "{}That integrator has no thermostat, the scene's has: {:.6g} K, friction {:.6g}/ps.",
            note.empty() ? "" : " ", settings.temperature, settings.friction);
    if (!note.empty() || is("langevin")) return note;
    return fmt::format(
        "The scene is Langevin dynamics at {:.6g} K with friction {:.6g}/ps; what else that "
        "integrator does is not taken over.",
        settings.temperature, settings.friction);
}

Settings settings_of(Files const& files) {
    if (!files.config.empty()) return calvados_settings(files);
    Settings settings;
    if (!files.integrator.empty())
        settings = integrator_settings(files.integrator);
    else if (!files.init_args.empty())
        settings = polychrom_settings(files);
    settings.tool = files.tool;
    if (!settings.notes.empty()) return settings;
    settings.notes.push_back(
        fmt::format("No settings of the run were found (config.yaml, one serialised Integrator): "
                    "{:.6g} K, friction {:.6g}/ps and {} steps of {:.6g} ps are assumed.",
                    settings.temperature, settings.friction, settings.steps, settings.step));
    return settings;
}

}  // namespace catena::foreign
