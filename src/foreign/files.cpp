// Implements the search for files, by their content where names do not tell.
#include "foreign/files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "error.hpp"
#include "foreign/calvados_folder.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

constexpr char const* how_to_write =
    "write it with OpenMM: open('system.xml', 'w').write(XmlSerializer.serialize(system))";

std::string shown(fs::path const& path) { return scene::shown_path(path.string()); }

/// Name of the root element of an XML file; empty if its first 64 kB hold none.
std::string root_of(fs::path const& file) {
    std::ifstream in(file, std::ios::binary);
    std::string text(65536, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    auto at = text.find('<');
    while (at != std::string::npos && at + 1 < text.size() &&
           std::isalpha(static_cast<unsigned char>(text[at + 1])) == 0)
        at = text.find('<', at + 1);
    if (at == std::string::npos) return "";
    return text.substr(at + 1, text.find_first_of(" \t\r\n/>", at) - at - 1);
}

/// True for the endings of PDB and mmCIF files, compressed or not.
bool is_topology(fs::path file) {
    if (file.extension() == ".gz") file = file.stem();
    return file.extension() == ".pdb" || file.extension() == ".cif" ||
           file.extension() == ".mmcif" || file.extension() == ".ent";
}

/// Files of a folder by what they hold, each list in alphabetical order.
struct Contents {
    std::vector<std::string> systems, states, integrators, topologies;
};

Contents contents_of(fs::path const& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code ignored;
        if (entry->is_regular_file(ignored)) files.push_back(entry->path());
    }
    if (error)
        throw InputError("the folder cannot be read: " + error.message(), shown(folder),
                         "check the path and its permissions");
    std::sort(files.begin(), files.end());
    Contents contents;
    for (fs::path const& file : files) {
        if (is_topology(file)) contents.topologies.push_back(file.string());
        if (file.extension() != ".xml") continue;
        std::string const root = root_of(file);
        if (root == "System") contents.systems.push_back(file.string());
        if (root == "State") contents.states.push_back(file.string());
        if (root == "Integrator") contents.integrators.push_back(file.string());
    }
    return contents;
}

/// File names without folders, for messages.
std::string names(std::vector<std::string> const& files) {
    std::vector<std::string> bare;
    for (std::string const& file : files) bare.push_back(shown(fs::path(file).filename()));
    return fmt::format("{}", fmt::join(bare, ", "));
}

/// Chooses the System: that of the CALVADOS package's configuration, or the only one.
std::string system_in(Files const& files, Contents const& contents) {
    if (!files.config.empty()) {
        fs::path const named = fs::path(files.folder) / (calvados_name(files.config) + ".xml");
        if (std::find(contents.systems.begin(), contents.systems.end(), named.string()) !=
            contents.systems.end())
            return named.string();
        throw InputError(
            fmt::format("there is no System {} beside config.yaml", shown(named.filename())),
            shown(files.folder),
            "start the package's run.py once, which writes it, or name a System");
    }
    if (contents.systems.empty())
        throw InputError("the folder holds no serialised System", shown(files.folder),
                         how_to_write);
    if (contents.systems.size() > 1)
        throw InputError(fmt::format("the folder holds {} Systems: {}", contents.systems.size(),
                                     names(contents.systems)),
                         shown(files.folder), "name one in place of the folder");
    return contents.systems.front();
}

/// Takes the topology or State that the user names.
void take_named(std::string const& named, Contents const& contents, Files& files) {
    std::error_code ignored;
    fs::path path = named;
    if (!fs::is_regular_file(path, ignored)) path = fs::path(files.folder) / named;
    if (!fs::is_regular_file(path, ignored))
        throw InputError("no such file", scene::shown_path(named),
                         "name a PDB or mmCIF file, or a serialised State");
    if (path.extension() != ".xml") {
        files.topology = path.string();
        return;
    }
    if (root_of(path) != "State")
        throw InputError("the file is not a serialised State", shown(path),
                         "name a PDB or mmCIF file, or a State with positions");
    files.state = path.string();
    if (contents.topologies.size() == 1) files.topology = contents.topologies.front();
}

/// Chooses topology or State in a folder of no known tool.
void take_only_one(Contents const& contents, Files& files) {
    if (contents.topologies.size() > 1)
        throw InputError(fmt::format("the folder holds {} topologies: {}",
                                     contents.topologies.size(), names(contents.topologies)),
                         shown(files.folder), "name one after the folder or System");
    if (contents.topologies.size() == 1) {
        files.topology = contents.topologies.front();
        if (!contents.states.empty())
            files.notes.push_back(fmt::format(
                "{} is not read: the start is that of {} (name the State after the folder or "
                "System to start from it).",
                names(contents.states), names(contents.topologies)));
        return;
    }
    if (contents.states.size() == 1) {
        files.state = contents.states.front();
        return;
    }
    throw InputError(contents.states.empty()
                         ? "the folder holds no topology (PDB, mmCIF) and no State"
                         : fmt::format("the folder holds {} States: {}", contents.states.size(),
                                       names(contents.states)),
                     shown(files.folder), "name the start's file after the folder or System");
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
    if (!is_folder && root_of(source) != "System")
        throw InputError("the file is not a serialised System", scene::shown_path(source),
                         how_to_write);
    files.system = is_folder ? system_in(files, contents) : source;
    if (contents.integrators.size() == 1) files.integrator = contents.integrators.front();
    if (contents.integrators.size() > 1 && files.config.empty())
        files.notes.push_back(
            fmt::format("{} serialised Integrators are not read: leave one in the folder.",
                        contents.integrators.size()));
    if (!topology.empty())
        take_named(topology, contents, files);
    else if (!take_calvados_start(files))
        take_only_one(contents, files);
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
