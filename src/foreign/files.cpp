// Implements the search for files, by their content where names do not tell.
#include "foreign/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "error.hpp"
#include "foreign/calvados_folder.hpp"
#include "foreign/contents.hpp"
#include "foreign/known_tools.hpp"
#include "foreign/start_choice.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

std::string shown(fs::path const& path) { return scene::shown_path(path.string()); }

/// Largest number of folders that are searched for a System.
int constexpr most_folders = 100;

/// Name of the first folder, by the alphabet, that holds a System within this one; empty if none
/// does.
std::string folder_with_system(fs::path const& folder) {
    std::vector<fs::path> below;
    std::error_code ended;
    for (fs::directory_iterator entry(folder, ended), end; !ended && entry != end;
         entry.increment(ended))
        if (std::error_code ignored; entry->is_directory(ignored)) below.push_back(entry->path());
    std::sort(below.begin(), below.end());
    if (below.size() > most_folders) below.resize(most_folders);
    for (fs::path const& each : below) {
        try {
            if (!contents_of(each).systems.empty()) return each.filename().string();
        } catch (InputError const&) {
            continue;  // a folder that cannot be read holds nothing to name
        }
    }
    return {};
}

/// Throws InputError if files are those of Catena or of a program whose input is not read.
void refuse_other_program(std::vector<std::string> const& all, fs::path const& folder) {
    if (auto const other = other_files(all))
        throw InputError(fmt::format("the folder holds {} ({}), and no serialised System",
                                     other->what, shown(other->name)),
                         shown(folder), other->remedy);
}

/// Key of a scene's chain that reads a file of that ending; empty if none does.
std::string key_for(std::string const& ending) {
    for (char const* const each : {".fasta", ".fa", ".faa", ".fna"})
        if (ending == each) return "fasta";
    for (char const* const each : {".pdb", ".ent", ".cif", ".mmcif"})
        if (ending == each) return "pdb";
    return {};
}

/// Throws InputError for a file that is not a System.
[[noreturn]] void refuse_file(std::string const& source, std::string const& tool) {
    auto const other = other_files({source});
    bool const is_config = fs::path(source).filename() == "config.yaml";
    if (other && !is_config)
        throw InputError(
            fmt::format("the file belongs to {}, and is no serialised System", other->what),
            scene::shown_path(source), other->remedy);
    std::string const key = key_for(fs::path(source).extension().string());
    throw InputError("the file is not a serialised System", scene::shown_path(source),
                     is_config      ? "name its folder"
                     : !key.empty() ? fmt::format("name the System first, or write a scene whose "
                                                  "`chains` have `{}: {}`",
                                                  key, fs::path(source).filename().string())
                                    : how_to_write(tool));
}

/// Chooses the System: that of the CALVADOS package's configuration, or the only one.
std::string system_in(Files const& files, Contents const& contents) {
    if (!files.config.empty()) {
        fs::path const named = fs::path(files.folder) / (calvados_name(files.config) + ".xml");
        if (std::find(contents.systems.begin(), contents.systems.end(), named.string()) !=
            contents.systems.end())
            return named.string();
        std::error_code ignored;
        std::string const name = shown(named.filename());
        throw InputError(fs::exists(named, ignored)
                             ? fmt::format("the file {} holds no serialised System", name)
                             : fmt::format("there is no System {} beside config.yaml", name),
                         shown(files.folder),
                         "start the package's run.py once, which writes it, or name a System");
    }
    if (contents.systems.empty() && !contents.no_systems.empty())
        throw InputError("the file holds no serialised System", shown(contents.no_systems.front()),
                         how_to_write(files.tool));
    if (contents.systems.empty()) {
        std::string const below = folder_with_system(files.folder);
        if (below.empty() && files.tool.empty()) refuse_other_program(contents.all, files.folder);
        throw InputError("the folder holds no serialised System", shown(files.folder),
                         below.empty()
                             ? how_to_write(files.tool)
                             : fmt::format("its folder {} holds one: name that", shown(below)));
    }
    if (contents.systems.size() > 1)
        throw InputError(fmt::format("the folder holds {} Systems: {}", contents.systems.size(),
                                     bare_names(contents.systems)),
                         shown(files.folder), "name one in place of the folder");
    return contents.systems.front();
}

/// Sets the only Integrator, where no configuration has the settings. Throws InputError for several
/// of them, and for a file that is an Integrator by its name alone.
void take_integrator(Contents const& contents, Files& files) {
    if (!files.config.empty()) {
        if (!contents.integrators.empty())
            files.notes.push_back(
                fmt::format("{} is not read: the settings are those of config.yaml.",
                            bare_names(contents.integrators)));
        return;
    }
    if (!contents.no_integrators.empty())
        throw InputError("the file holds no serialised Integrator",
                         shown(contents.no_integrators.front()),
                         "write it with OpenMM's XmlSerializer.serialize(integrator), or move it "
                         "out of the folder and set the dynamics yourself");
    if (contents.integrators.size() > 1)
        throw InputError(fmt::format("the folder holds {} Integrators: {}",
                                     contents.integrators.size(), bare_names(contents.integrators)),
                         shown(files.folder), "leave the one of the run in the folder");
    if (contents.integrators.empty()) return;
    files.integrator = contents.integrators.front();
    if (!files.init_args.empty())
        files.notes.push_back(fmt::format("{} is not read: the settings are those of {}.",
                                          bare_names({files.init_args}),
                                          bare_names({files.integrator})));
}

/// Notes a configuration of the package whose System is another than the one that the user names.
void note_other_name(Files& files) {
    if (files.config.empty()) return;
    std::string const stem = fs::path(files.system).stem().string(),
                      named = calvados_name(files.config);
    if (stem != named)
        files.notes.push_back(
            fmt::format("The settings are those of config.yaml, which is of {} and not of {}.",
                        scene::shown(named), scene::shown(stem)));
}

}  // namespace

Files find_files(std::string const& source, std::string const& topology) {
    std::error_code ignored;
    bool const is_folder = fs::is_directory(source, ignored);
    if (!is_folder && !fs::is_regular_file(source, ignored))
        throw InputError("no such file or folder", scene::shown_path(source),
                         "name a folder, or a serialised System (XML)");
    Files files;
    fs::path const parent = is_folder ? fs::path(source) : fs::path(source).parent_path();
    files.folder = parent.empty() ? "." : parent.string();
    Contents const contents = contents_of(files.folder);
    find_calvados_files(files);
    if (files.config.empty()) find_known_tool(contents.all, files);
    if (!is_folder && root_of(source) != "System") refuse_file(source, files.tool);
    files.system = is_folder ? system_in(files, contents) : source;
    note_other_name(files);
    take_integrator(contents, files);
    if (!topology.empty())
        take_named_start(topology, contents, files);
    else if (take_calvados_start(files))
        refuse_unfit_topology(files,
                              "name another frame after the folder, or start the package's run.py "
                              "again, which writes System and top.pdb");
    else
        take_only_start(contents, files);
    return files;
}

std::string name_of(Files const& files) {
    std::string const stem = fs::path(files.system).stem().string();
    if (stem != "system" && stem != "System") return stem;
    std::error_code ignored;
    std::string const folder = fs::absolute(files.folder, ignored).lexically_normal().string();
    fs::path const path = folder.ends_with('/') ? fs::path(folder).parent_path() : fs::path(folder);
    return path.has_filename() ? path.filename().string() : stem;
}

}  // namespace catena::foreign
