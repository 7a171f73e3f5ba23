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
#include "foreign/known_tools.hpp"
#include "io/output_file.hpp"
#include "scene/node.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

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
    std::vector<std::string> all, systems, states, integrators, topologies;
    /// Files whose name promises an Integrator, and that hold none.
    std::vector<std::string> no_integrators;
};

/// True for a file named integrator.xml or the like that holds none of OpenMM's objects.
bool is_no_integrator(fs::path const& file, std::string const& root) {
    std::string name = file.stem().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name == "integrator" ||
           (name.find("integrator") != std::string::npos && root != "System" && root != "State");
}

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
        contents.all.push_back(file.string());
        if (is_topology(file)) contents.topologies.push_back(file.string());
        if (file.extension() != ".xml") continue;
        std::string const root = root_of(file);
        if (root == "System") contents.systems.push_back(file.string());
        if (root == "State") contents.states.push_back(file.string());
        if (root == "Integrator")
            contents.integrators.push_back(file.string());
        else if (is_no_integrator(file, root))
            contents.no_integrators.push_back(file.string());
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
                         how_to_write(files.tool));
    if (contents.systems.size() > 1)
        throw InputError(fmt::format("the folder holds {} Systems: {}", contents.systems.size(),
                                     names(contents.systems)),
                         shown(files.folder), "name one in place of the folder");
    return contents.systems.front();
}

/// A topology with its chains; none if it cannot be read.
struct Candidate {
    std::string file;
    std::vector<PdbChain> chains = {};

    std::size_t atoms() const {
        std::size_t sum = 0;
        for (PdbChain const& chain : chains) sum += chain.size();
        return sum;
    }
};

Candidate read_candidate(std::string const& file) {
    try {
        return {file, read_pdb_topology(file, file)};
    } catch (InputError const&) {  // refused with its reason where it is chosen
        return {file};
    }
}

/// Number of particles of a serialised System, by the tags between <Particles> and </Particles>.
std::size_t particles_of(std::string const& system) {
    std::string const xml = read_text_file(system);
    std::size_t const end = xml.find("</Particles>");
    std::size_t count = 0;
    for (auto at = xml.find("<Particle "); at < end; at = xml.find("<Particle ", at + 1)) ++count;
    return count;
}

/// "a.pdb (10 atoms), b.pdb (20 atoms)".
std::string sizes(std::vector<Candidate> const& candidates) {
    std::vector<std::string> each;
    for (Candidate const& one : candidates)
        each.push_back(
            fmt::format("{} ({} atoms)", shown(fs::path(one.file).filename()), one.atoms()));
    return fmt::format("{}", fmt::join(each, ", "));
}

/// Takes the State as the start; the topology, if there is one, names chains and residues.
void take_state(Candidate const* topology, std::string const& state, Files& files) {
    files.state = state;
    if (topology != nullptr) files.topology = topology->file;
}

/// Takes the topology of a tool that writes nanometres into the columns of angstrom: with the
/// positions of the only State. Returns false for others. Throws InputError without a State.
bool take_in_nanometres(Candidate const& topology, Contents const& contents, Files& files) {
    if (!is_in_nanometres(files.tool, topology.chains)) return false;
    std::string const name = shown(fs::path(topology.file).filename());
    if (contents.states.size() != 1)
        throw InputError(
            fmt::format("{} writes nanometres where a PDB file has angstrom", files.tool),
            shown(topology.file),
            fmt::format("leave one State in the folder, whose positions count; {}",
                        how_to_write(files.tool)));
    take_state(&topology, contents.states.front(), files);
    files.notes.push_back(fmt::format(
        "The start has the positions of {}; {} has nanometres where a PDB file has angstrom.",
        names(contents.states), name));
    return true;
}

/// Takes the only topology with as many atoms as the System has particles. Without one, takes the
/// only State. Throws InputError if neither decides.
void take_fitting(Contents const& contents, Files& files) {
    std::size_t const particles = particles_of(files.system);
    std::vector<Candidate> fitting, others;
    for (std::string const& file : contents.topologies) {
        Candidate one = read_candidate(file);
        (one.atoms() == particles ? fitting : others).push_back(std::move(one));
    }
    if (fitting.size() > 1)
        throw InputError(
            fmt::format("{} topologies of the folder have the System's {} particles: {}",
                        fitting.size(), particles, sizes(fitting)),
            shown(files.folder), "name one after the folder or System");
    std::string const left_out =
        fmt::format("{}: the System has {} particles.", sizes(others), particles);
    if (fitting.empty()) {
        if (contents.states.size() != 1)
            throw InputError(
                fmt::format("no topology of the folder has the System's {} particles: {}",
                            particles, sizes(others)),
                shown(files.folder),
                "name the start's file after the folder or System, or serialise a "
                "State beside it");
        take_state(nullptr, contents.states.front(), files);
        files.notes.push_back(
            fmt::format("The start is {}. Not read are {}", names(contents.states), left_out));
        return;
    }
    files.notes.push_back(
        fmt::format("The topology is {}. Not read are {}", sizes(fitting), left_out));
    if (take_in_nanometres(fitting.front(), contents, files)) return;
    files.topology = fitting.front().file;
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
        if (!take_in_nanometres(read_candidate(path.string()), contents, files))
            files.topology = path.string();
        return;
    }
    if (root_of(path) != "State")
        throw InputError("the file is not a serialised State", shown(path),
                         "name a PDB or mmCIF file, or a State with positions");
    files.state = path.string();
    if (contents.topologies.size() == 1) files.topology = contents.topologies.front();
}

/// Chooses topology or State in a folder without a configuration of the CALVADOS package.
void take_only_one(Contents const& contents, Files& files) {
    if (contents.topologies.size() > 1) {
        take_fitting(contents, files);
    } else if (contents.topologies.size() == 1) {
        if (take_in_nanometres(read_candidate(contents.topologies.front()), contents, files))
            return;
        files.topology = contents.topologies.front();
    } else if (contents.states.size() == 1) {
        files.state = contents.states.front();
    } else {
        throw InputError(contents.states.empty()
                             ? "the folder holds no topology (PDB, mmCIF) and no State"
                             : fmt::format("the folder holds {} States: {}", contents.states.size(),
                                           names(contents.states)),
                         shown(files.folder), "name the start's file after the folder or System");
    }
    if (files.state.empty() && !contents.states.empty())
        files.notes.push_back(fmt::format(
            "{} is not read: the start is that of {} (name the State after the folder or System to "
            "start from it).",
            names(contents.states), shown(fs::path(files.topology).filename())));
}

/// Sets the only Integrator, where no configuration has the settings. Throws InputError for several
/// of them, and for a file that is an Integrator by its name alone.
void take_integrator(Contents const& contents, Files& files) {
    if (!files.config.empty()) return;
    if (!contents.no_integrators.empty())
        throw InputError("the file holds no serialised Integrator",
                         shown(contents.no_integrators.front()),
                         "write it with OpenMM's XmlSerializer.serialize(integrator), or move it "
                         "out of the folder and set the dynamics yourself");
    if (contents.integrators.size() > 1)
        throw InputError(fmt::format("the folder holds {} Integrators: {}",
                                     contents.integrators.size(), names(contents.integrators)),
                         shown(files.folder), "leave the one of the run in the folder");
    if (!contents.integrators.empty()) files.integrator = contents.integrators.front();
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
    if (!is_folder && root_of(source) != "System")
        throw InputError("the file is not a serialised System", scene::shown_path(source),
                         how_to_write(files.tool));
    files.system = is_folder ? system_in(files, contents) : source;
    take_integrator(contents, files);
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
