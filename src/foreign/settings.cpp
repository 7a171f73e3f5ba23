// Implements the settings of serialised Integrators and the defaults.
#include "foreign/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Friction from which a note is written, 1/ps. Water stops a residue within about 0.02 ps.
constexpr double most_friction = 100;

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
            refuse_value(name, written->second);
        value = read;
        return true;
    }
    [[noreturn]] void refuse_value(char const* name, std::string const& value) const {
        refuse(fmt::format("{} of the integrator is `{}`", name, scene::shown(value)));
    }
    /// Throws InputError if the attribute is missing, or 0 where it must not be.
    void need(char const* name, bool may_be_zero) const {
        auto const written = attributes.find(name);
        if (written == attributes.end())
            refuse(fmt::format("the integrator has no {}: the file is damaged", name));
        double read = 0;
        scene::parse_number(written->second, read);
        if (read == 0 && !may_be_zero) refuse_value(name, written->second);
    }
};

std::string in_lower_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// Kinds of integrators of OpenMM and its plugins, without "Integrator".
constexpr std::array<std::string_view, 14> kinds = {
    "verlet",   "variableverlet", "langevin",      "langevinmiddle", "variablelangevin",
    "brownian", "nosehoover",     "custom",        "compound",       "dpd",
    "qtb",      "rpmd",           "drudelangevin", "drudenosehoover"};

/// True for the Langevin dynamics of a plugin, such as ICLangevinIntegrator. `lower` is the kind
/// in lower case.
bool is_langevin_of_plugin(IntegratorTag const& tag, std::string_view lower) {
    bool const named = lower.ends_with("langevin") || lower.ends_with("langevinmiddle");
    return named && tag.attributes.contains("temperature") && tag.attributes.contains("friction") &&
           tag.attributes.contains("stepSize");
}

/// Kind of an integrator in lower case and without "integrator".
std::string without_integrator(std::string const& kind) {
    std::string lower = in_lower_case(kind);
    std::string_view const end = "integrator";
    if (lower.ends_with(end)) lower.resize(lower.size() - end.size());
    return lower;
}

/// Throws InputError for an integrator of which it is not known what it does.
void refuse_unknown(IntegratorTag const& tag, std::string const& kind) {
    std::string const lower = without_integrator(kind);
    if (std::find(kinds.begin(), kinds.end(), lower) != kinds.end()) return;
    if (is_langevin_of_plugin(tag, lower)) return;
    throw InputError(fmt::format("`{}` is no integrator that is known", scene::shown(kind)),
                     scene::shown_path(tag.file),
                     "write the one of the run again, or move the file out of the folder and set "
                     "the dynamics yourself");
}

/// Throws InputError if an attribute is missing that OpenMM writes for this kind of integrator.
void refuse_incomplete(IntegratorTag const& tag, std::string const& kind) {
    std::string const lower = in_lower_case(kind);
    auto const is = [&](char const* part) { return lower.find(part) != std::string::npos; };
    bool const random = is("langevin") || is("brownian");
    if (random)
        for (char const* const name : {"temperature", "friction"}) tag.need(name, true);
    if (random || is("verlet") || is("nosehoover")) tag.need("stepSize", is("variable"));
}

/// Reads temperature, friction and step of a Langevin integrator, the step of another one. Throws
/// InputError for a file that is damaged or holds something else.
Settings integrator_settings(std::string const& file) {
    std::string const xml = read_text_file(file);
    XmlOutline const outline =
        scan_system_xml(xml, scene::shown_path(file), "settings of the dynamics");
    IntegratorTag const tag{file, outline.attributes};
    if (outline.root != "Integrator" || !outline.type.ends_with("Integrator"))
        tag.refuse("the file holds no serialised Integrator");
    refuse_unknown(tag, outline.type);
    refuse_incomplete(tag, outline.type);
    Settings settings;
    Found found{};
    found.temperature = tag.take("temperature", settings.temperature, 0);
    found.friction = tag.take("friction", settings.friction, 0);
    double step = 0;  // it stays 0 for variable steps before the first one
    if (tag.take("stepSize", step, 0) && step > 0) {
        found.step = true;
        settings.step = step;
    }
    auto const place = [&](char const* name) { return scene::shown_path(file) + ": " + name; };
    settings.origins = {{"dynamics.temperature", place("temperature")},
                        {"dynamics.friction", place("friction")},
                        {"dynamics.step", place("stepSize")}};
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
    std::string const lower = in_lower_case(kind);
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
    std::string const name = without_integrator(kind);
    if (!note.empty() || name == "langevin" || name == "langevinmiddle") return note;
    return fmt::format(
        "The scene is Langevin dynamics at {:.6g} K with friction {:.6g}/ps; what else that "
        "integrator does is not taken over.",
        settings.temperature, settings.friction);
}

namespace {

/// Settings of the folder before they are checked.
Settings unchecked_settings(Files const& files) {
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

/// Throws InputError for a temperature that no scene with links can have.
void refuse_temperature(Settings const& settings) {
    if (settings.temperature > 0 && settings.temperature <= hottest) return;
    auto const origin = settings.origins.find("dynamics.temperature");
    throw InputError(fmt::format("the temperature is {:.6g} K", settings.temperature),
                     origin == settings.origins.end() ? "settings" : origin->second,
                     fmt::format("give one above 0 and at most {:g} K, such as 300", hottest));
}

/// Notes a friction beyond that of any liquid.
void note_friction(Settings& settings) {
    if (settings.friction < most_friction) return;
    auto const origin = settings.origins.find("dynamics.friction");
    settings.notes.push_back(
        fmt::format("A friction of {:.6g}/ps stops velocities within {:.3g} ps; Langevin dynamics "
                    "of chains has 0.01 to 50/ps. Correct {} if that is not meant.",
                    settings.friction, 1 / settings.friction,
                    origin == settings.origins.end() ? "it" : "(" + origin->second + ")"));
}

}  // namespace

Settings settings_of(Files const& files) {
    Settings settings = unchecked_settings(files);
    refuse_temperature(settings);
    note_friction(settings);
    return settings;
}

}  // namespace catena::foreign
