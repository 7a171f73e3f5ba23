// Implements what is known of the CALVADOS package (version 0.8, calvados/sim.py and
// calvados/data/default_config.yaml). Its integrator is LangevinMiddle with steps of 0.01 ps.
#include "foreign/calvados_folder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string_view>

#include "error.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;
using scene::Node;

bool is_file(fs::path const& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

constexpr double most_whole = 1e15;

/// True for well-formed YAML that is empty, a list or a single value.
bool is_no_map(std::string const& text) {
    try {
        return scene::parse_value(text, "").kind != Node::Kind::map;
    } catch (InputError const&) {
        return false;
    }
}

/// Parses a file of keys and values. Throws InputError for other contents.
std::unique_ptr<Node> parsed(std::string const& text, std::string const& file) {
    if (is_no_map(text))
        throw InputError("the file holds no keys with values", scene::shown_path(file),
                         "write it again, or move it out of the folder");
    return scene::parse_document(text, file);
}

/// A YAML file of the package.
class Settled {
  public:
    explicit Settled(std::string const& file) {
        Node at;
        at.text = file;
        root_ = parsed(scene::read_text_file(file, at), file);
    }
    Node const& root() const { return *root_; }
    /// Entry with a value; nullptr if it is absent, empty or null.
    Node const* find(std::string_view key) const {
        Node const* const node = root_->find(key);
        bool const none = node == nullptr || node->kind == Node::Kind::null ||
                          node->text == "null" || node->text == "~";
        return none ? nullptr : node;
    }
    /// Number of that key, or the default of the package.
    double number(std::string_view key, double otherwise) const {
        Node const* const node = find(key);
        return node ? scene::number(*node) : otherwise;
    }
    /// The same for a number of 0 or more.
    double non_negative(std::string_view key, double otherwise) const {
        Node const* const node = find(key);
        return node ? scene::non_negative(*node) : otherwise;
    }
    /// Whole number of that key, which may be written as 1e8 or 100000000.0.
    std::int64_t whole(std::string_view key, double otherwise, std::int64_t least) const {
        double const found = number(key, otherwise);
        if (!(found >= static_cast<double>(least) && found <= most_whole &&
              found == std::floor(found)))
            scene::fail(*find(key),
                        fmt::format("`{}` is not a whole number of {} or more", key, least),
                        "correct it");
        return static_cast<std::int64_t>(found);
    }
    bool truth(std::string_view key) const {
        Node const* const node = find(key);
        return node != nullptr && scene::truth(*node);
    }
    std::string text(std::string_view key, char const* otherwise) const {
        Node const* const node = find(key);
        return node ? scene::text(*node) : otherwise;
    }

  private:
    std::unique_ptr<Node> root_;
};

/// True if a component has restraints within its domains.
bool has_restraints(std::string const& components) {
    if (components.empty()) return false;
    Settled const file(components);
    auto const restrained = [](Node const& map) {
        Node const* const node = map.find("restraint");
        return node != nullptr && scene::truth(*node);
    };
    Node const* const defaults = file.root().find("defaults");
    if (defaults != nullptr && restrained(*defaults)) return true;
    Node const* const system = file.root().find("system");
    for (std::size_t i = 0; system != nullptr && i < system->items.size(); ++i)
        if (restrained(system->items[i])) return true;
    return false;
}

/// Reads the friction. Version 0.8 reads `friction_coeff`; earlier ones read `friction`.
double friction_of(Settled const& config, Settings& settings) {
    double const friction =
        config.non_negative("friction_coeff", config.non_negative("friction", settings.friction));
    if (double const other = config.non_negative("friction", friction); other != friction)
        settings.notes.push_back(
            fmt::format("config.yaml has friction {:.6g} and friction_coeff {:.6g}; the package "
                        "reads the latter, and so does the scene.",
                        other, friction));
    return friction;
}

/// True if the start is a frame after the package's equilibration.
bool is_equilibrated(Files const& files) {
    std::string const name = fs::path(files.topology).filename().string();
    return name == "checkpoint.pdb" || name == "equilibration_final.pdb";
}

/// True if the System holds a force of that kind.
bool holds(std::string const& system, std::string const& kind) {
    Node at;
    at.text = system;
    return scene::read_text_file(system, at).find('"' + kind + '"') != std::string::npos;
}

/// Reads `slab_eq`: a CustomExternalForce that the package removes after `steps_eq` steps. Systems
/// that a continued run of the package has written lack it.
void read_slab(Settled const& config, Files const& files, Settings& settings) {
    char const* const force = "CustomExternalForce";
    if (!config.truth("slab_eq") || !holds(files.system, force)) return;
    settings.equilibration_forces = {force};
    if (!is_equilibrated(files)) settings.equilibration_steps = config.whole("steps_eq", 1000, 0);
}

/// True for a configuration of the package. Throws InputError for one that was cut: the package
/// writes its keys in alphabetical order.
bool is_of_package(Settled const& config, std::string const& file) {
    bool const named = config.find("sysname") != nullptr;
    bool const alike = config.find("friction_coeff") && config.find("ext_force_expr");
    if (!named && !alike) return false;
    for (char const* const key : {"sysname", "temp"})
        if (!config.find(key))
            throw InputError(fmt::format("the configuration has no `{}`", key),
                             scene::shown_path(file),
                             "write it again with the package's prepare.py, or move it out of the "
                             "folder to import the System alone");
    return true;
}

/// Notes the keys whose defaults count because the file lacks them.
void note_absent(Settled const& config, Settings& settings) {
    auto const note = [&](char const* key, double value) {
        if (!config.find(key))
            settings.notes.push_back(
                fmt::format("config.yaml has no `{}`; {:.9g} is assumed.", key, value));
    };
    note("steps", static_cast<double>(settings.steps));
    note("wfreq", static_cast<double>(settings.every));
    if (!config.find("friction")) note("friction_coeff", settings.friction);
}

}  // namespace

void find_calvados_files(Files& files) {
    fs::path const config = fs::path(files.folder) / "config.yaml",
                   components = fs::path(files.folder) / "components.yaml";
    if (!is_file(config)) return;
    if (!is_of_package(Settled(config.string()), config.string())) {
        files.notes.push_back(
            "config.yaml is not read: it has no `sysname`, which the CALVADOS package writes.");
        return;
    }
    files.config = config.string();
    if (is_file(components)) files.components = components.string();
}

std::string calvados_name(std::string const& config) { return Settled(config).text("sysname", ""); }

bool take_calvados_start(Files& files) {
    if (files.config.empty()) return false;
    fs::path const folder = files.folder;
    Settled const config(files.config);
    fs::path const given = folder / config.text("frestart", "restart.chk");
    std::vector<fs::path> starts;
    if (config.text("restart", "checkpoint") == "pdb") starts.push_back(given);
    for (char const* const name : {"checkpoint.pdb", "equilibration_final.pdb", "top.pdb"})
        starts.push_back(folder / name);
    for (fs::path const& start : starts) {
        if (!is_file(start)) continue;
        files.topology = start.string();
        std::string const name = scene::shown_path(start.filename().string());
        if (start != starts.back())
            files.notes.push_back(
                fmt::format("The start is {}, a frame of the package's run (name top.pdb after the "
                            "folder for its first start).",
                            name));
        else if (is_file(folder / "restart.chk"))
            files.notes.push_back(
                "restart.chk is not read: OpenMM's checkpoints fit one platform and version. The "
                "start is top.pdb.");
        return true;
    }
    return false;
}

Settings calvados_settings(Files const& files) {
    Settled const config(files.config);
    Settings settings;
    settings.tool = "CALVADOS package";
    settings.temperature = config.non_negative("temp", settings.temperature);
    settings.friction = friction_of(config, settings);
    settings.steps = config.whole("steps", 100000000, 0);
    settings.every = config.whole("wfreq", 100000, 1);
    settings.seed = static_cast<std::uint64_t>(config.whole("random_number_seed", 1, 0));
    note_absent(config, settings);
    settings.minimises = fs::path(files.topology).filename() == "top.pdb";
    if (config.number("runtime", 0) > 0)
        settings.notes.push_back(
            fmt::format("config.yaml ends the run after {:.6g} hours; the scene has steps instead.",
                        config.number("runtime", 0)));
    read_slab(config, files, settings);
    if (has_restraints(files.components))
        settings.notes.push_back(
            "The package's elastic networks stay forces. To move domains as rigid bodies, write "
            "`chains` with `rigid`.");
    return settings;
}

}  // namespace catena::foreign
