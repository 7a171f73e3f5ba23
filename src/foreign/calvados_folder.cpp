// Implements what is known of the CALVADOS package (version 0.8, calvados/sim.py and
// calvados/data/default_config.yaml). Its integrator is LangevinMiddle with steps of 0.01 ps.
#include "foreign/calvados_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>

#include "error.hpp"
#include "foreign/calvados_checks.hpp"
#include "foreign/contents.hpp"
#include "foreign/package_file.hpp"
#include "foreign/system_text.hpp"
#include "io/output_file.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t lowest_seed = std::numeric_limits<std::int32_t>::min();

bool is_file(fs::path const& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

/// Reads the friction. Version 0.8 reads `friction_coeff`; earlier ones read `friction`.
double friction_of(PackageFile const& config, Settings& settings) {
    double const friction =
        config.non_negative("friction_coeff", config.non_negative("friction", settings.friction));
    if (double const other = config.non_negative("friction", friction); other != friction)
        settings.notes.push_back(
            fmt::format("config.yaml has friction {:.6g} and friction_coeff {:.6g}; the package "
                        "reads the latter, and so does the scene.",
                        other, friction));
    if (friction == 0)
        settings.notes.push_back(
            "config.yaml has friction 0: without a thermostat its temperature is that of the start "
            "only.");
    return friction;
}

/// Reads the seed. OpenMM's may be negative, those of scenes are not.
std::uint64_t seed_of(PackageFile const& config, Settings& settings) {
    std::int64_t const seed = config.whole("random_number_seed", 1, lowest_seed);
    if (seed < 0)
        settings.notes.push_back(
            fmt::format("config.yaml has random_number_seed {}; the scene has {}.", seed, -seed));
    return static_cast<std::uint64_t>(std::abs(seed));
}

/// True if the start is a frame after the package's equilibration.
bool is_equilibrated(Files const& files) {
    std::string const name = fs::path(files.topology).filename().string();
    return name == "checkpoint.pdb" || name == "equilibration_final.pdb";
}

/// Reads `slab_eq`: a CustomExternalForce that the package removes after `steps_eq` steps. Systems
/// that a continued run of the package has written lack it.
void read_slab(PackageFile const& config, Files const& files, Settings& settings) {
    char const* const force = "CustomExternalForce";
    if (!config.truth("slab_eq") || !SystemText(files.system).holds(force)) return;
    settings.equilibration_forces = {force};
    if (is_equilibrated(files)) return;
    settings.equilibration_steps = config.whole("steps_eq", 1000, 0);
    if (!config.find("steps_eq"))
        settings.notes.push_back("config.yaml has no `steps_eq`; 1000 is assumed.");
}

/// True for a configuration of the package, which is certain beside components.yaml. Throws
/// InputError for one that was cut: the package writes its keys in alphabetical order.
bool is_of_package(PackageFile const& config, std::string const& file, bool certain) {
    bool const named = config.find("sysname") != nullptr;
    bool const alike = config.find("friction_coeff") && config.find("ext_force_expr");
    if (!named && !alike && !certain) return false;
    for (char const* const key : {"sysname", "temp"})
        if (!config.find(key))
            throw InputError(fmt::format("the configuration has no `{}`", key),
                             scene::shown_path(file),
                             "write it again with the package's prepare.py, or move it out of the "
                             "folder to import the System alone");
    return true;
}

/// True if a line of the file begins with `sysname:`, whatever the other lines hold.
bool names_system(std::string const& file) {
    std::string const text = read_text_file(file);
    return text.starts_with("sysname:") || text.find("\nsysname:") != std::string::npos;
}

/// Reads config.yaml. A file that is no YAML with keys is refused if it is the package's, and is
/// noted and left out otherwise: other programs have a file of that name, too.
std::optional<PackageFile> read_if_packages(std::string const& file, bool certain, Files& files) {
    try {
        return PackageFile(file);
    } catch (InputError const& error) {
        if (certain || names_system(file)) throw;
        std::string const what = error.what();
        files.notes.push_back(fmt::format(
            "config.yaml is not read: {}. It is not the CALVADOS package's, for it has no "
            "`sysname` and no components.yaml beside it.",
            what.substr(0, what.find("): ") + 1)));
        return std::nullopt;
    }
}

/// Throws InputError for a start that is no structure by its name, such as OpenMM's checkpoint.
void refuse_no_structure(PackageFile const& config, fs::path const& start,
                         std::string const& restart) {
    if (is_topology(start)) return;
    std::string const name = scene::shown_path(start.filename().string());
    throw InputError(
        fmt::format(
            "`restart` is {}, and {} ({}) is no PDB or mmCIF file", scene::shown(restart), name,
            config.find("frestart") != nullptr ? "`frestart`" : "the default of `frestart`"),
        config.place(config.find("frestart") != nullptr ? "frestart" : "restart"),
        "write the structure's name in `frestart`, or `restart: checkpoint` to start from "
        "checkpoint.pdb or top.pdb");
}

/// Notes the keys whose defaults count because the file lacks them.
void note_absent(PackageFile const& config, Settings& settings) {
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
    bool const certain = is_file(components);
    if (certain && !is_file(config))
        files.notes.push_back(
            "components.yaml is not read: the CALVADOS package's config.yaml is not beside it.");
    if (!is_file(config)) return;
    std::optional<PackageFile> const read = read_if_packages(config.string(), certain, files);
    if (!read) return;
    if (!is_of_package(*read, config.string(), certain)) {
        files.notes.push_back(
            "config.yaml is not read: it has no `sysname`, which the CALVADOS package writes.");
        return;
    }
    refuse_cut(*read, files.notes);
    files.config = config.string();
    if (certain) files.components = components.string();
}

std::string calvados_name(std::string const& config) {
    return PackageFile(config).text("sysname", "");
}

bool take_calvados_start(Files& files) {
    if (files.config.empty()) return false;
    fs::path const folder = files.folder;
    PackageFile const config(files.config);
    fs::path const given = folder / config.text("frestart", "restart.chk");
    std::vector<fs::path> starts;
    std::string const restart = config.text("restart", "checkpoint");
    if (restart != "checkpoint" && restart != "pdb" && restart != "cif")
        throw InputError(fmt::format("`restart` is `{}`", scene::shown(restart)),
                         config.place("restart"), "write checkpoint, pdb, cif or null");
    bool const named = restart != "checkpoint", lost = named && !is_file(given);
    if (named && !lost) refuse_no_structure(config, given, restart);
    if (named) starts.push_back(given);
    for (char const* const name : {"checkpoint.pdb", "equilibration_final.pdb", "top.pdb"})
        starts.push_back(folder / name);
    for (fs::path const& start : starts) {
        if (!is_file(start)) continue;
        files.topology = start.string();
        std::string const name = scene::shown_path(start.filename().string());
        if (lost)
            files.notes.push_back(
                fmt::format("config.yaml starts from {}, which is not there: the start is {}.",
                            scene::shown_path(given.string()), name));
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
    PackageFile const config(files.config);
    Settings settings;
    settings.tool = "CALVADOS package";
    settings.temperature = config.non_negative("temp", settings.temperature);
    settings.friction = friction_of(config, settings);
    settings.steps = config.whole("steps", 100000000, 0);
    settings.every = config.whole("wfreq", 100000, 1);
    settings.seed = seed_of(config, settings);
    settings.origins = {
        {"dynamics.temperature", config.place("temp")},
        {"dynamics.friction",
         config.place(config.find("friction_coeff") ? "friction_coeff" : "friction")},
        {"dynamics.steps", config.place("steps")},
        {"dynamics.seed", config.place("random_number_seed")},
        {"output.every", config.place("wfreq")}};
    note_absent(config, settings);
    settings.minimises = fs::path(files.topology).filename() == "top.pdb";
    if (config.number("runtime", 0) > 0)
        settings.notes.push_back(
            fmt::format("config.yaml ends the run after {:.6g} hours; the scene has steps instead.",
                        config.number("runtime", 0)));
    bool const is_first = files.state.empty() && settings.minimises;
    check_package(config, files, !is_first, settings);
    read_slab(config, files, settings);
    return settings;
}

}  // namespace catena::foreign
