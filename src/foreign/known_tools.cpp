// Implements what is known of OpenMiChroM 1.1 and polychrom 0.1.
#include "foreign/known_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "scene/node.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

constexpr char const *openmichrom = "OpenMiChroM", *polychrom = "polychrom";
/// Mean distance of neighbours, nm, between the tools' 1 nm and its tenth.
constexpr double longest_tenth = 0.3;

/// True for the names PREFIX...h5.
bool is_named(fs::path const& file, char const* prefix) {
    return file.extension() == ".h5" && file.filename().string().starts_with(prefix);
}

bool is_of_openmichrom(fs::path const& file) {
    fs::path const ending = file.extension();
    return ending == ".ndb" || ending == ".cndb" || ending == ".swb" ||
           file.filename() == "initialStats.txt";
}

/// First lines of a text, each cut.
std::vector<std::string> first_lines(fs::path const& file) {
    std::size_t constexpr most_lines = 200, most_bytes = 65536, longest = 200;
    std::ifstream in(file, std::ios::binary);
    std::string text(most_bytes, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size() && lines.size() < most_lines;) {
        std::size_t const end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, std::min(end - at, longest)));
        at = end + 1;
    }
    return lines;
}

bool has_line(fs::path const& file, std::regex const& form) {
    std::vector<std::string> const lines = first_lines(file);
    return std::any_of(lines.begin(), lines.end(),
                       [&](std::string const& line) { return std::regex_search(line, form); });
}

bool is_run(fs::path const& file) {
    std::string const name = file.filename().string();
    return name == "trajectory.h5md" || name == "checkpoint.h5" || name == "checkpoint.previous.h5";
}

bool is_scene(fs::path const& file) {
    static std::regex const key("^(chains|dynamics|forces):");
    bool const yaml = file.extension() == ".yaml" || file.extension() == ".yml";
    return yaml && has_line(file, key);
}

/// True for a script (in.melt, melt.in), a table of atoms (data.melt, melt.data) or output.
bool is_of_lammps(fs::path const& file) {
    static std::regex const script("^ *(pair_style|atom_style|read_data|bond_style)\\b"),
        table("^ *[0-9]+ +atoms\\b");
    std::string const name = file.filename().string(), ending = file.extension().string();
    if (name == "log.lammps" || ending == ".lammpstrj" || ending == ".lammps" || ending == ".lmp")
        return true;
    if (name.starts_with("in.") || ending == ".in") return has_line(file, script);
    return (name.starts_with("data.") || ending == ".data") && has_line(file, table);
}

bool ends_in(fs::path const& file, std::set<std::string> const& endings) {
    return endings.contains(file.extension().string());
}

/// A program, how to tell its files, and what to do with them.
struct Program {
    char const* what;
    bool (*has)(fs::path const&);
    std::string (*remedy)(fs::path const&);
};

/// Advice for programs whose input OpenMM's module `app` reads.
template <char const* reader>
std::string by_openmm(fs::path const&) {
    return fmt::format(
        "read it with OpenMM's app.{}, and write createSystem() with XmlSerializer as system.xml "
        "beside a PDB file of the start",
        reader);
}

/// Advice for programs whose input OpenMM does not read.
std::string by_hand(fs::path const&) {
    return "write its chains in a scene, or build the System with OpenMM in Python and serialise "
           "it "
           "as system.xml beside a PDB file of the start";
}

std::string of_run(fs::path const& file) {
    std::string const folder = scene::shown_path(file.parent_path().string());
    return fmt::format(
        "continue it by `catena run SCENE --restart {}/checkpoint.h5`, or start a scene from it by "
        "`start: {{from: {}, frame: last}}`",
        folder, folder);
}

std::string of_scene(fs::path const& file) {
    return fmt::format("run it by `catena run {}`", scene::shown_path(file.string()));
}

constexpr char gromacs[] = "GromacsTopFile", amber[] = "AmberPrmtopFile",
               charmm[] = "CharmmPsfFile";

std::array const programs = {
    Program{"a run of Catena", is_run, of_run},
    Program{"a scene of Catena", is_scene, of_scene},
    Program{"LAMMPS input", is_of_lammps, by_hand},
    Program{"GROMACS input",
            [](fs::path const& f) { return ends_in(f, {".gro", ".top", ".itp", ".mdp", ".tpr"}); },
            by_openmm<gromacs>},
    Program{"Amber input",
            [](fs::path const& f) { return ends_in(f, {".prmtop", ".parm7", ".inpcrd", ".rst7"}); },
            by_openmm<amber>},
    Program{"CHARMM input", [](fs::path const& f) { return ends_in(f, {".psf"}); },
            by_openmm<charmm>},
    Program{"HOOMD-blue input", [](fs::path const& f) { return ends_in(f, {".gsd"}); }, by_hand}};

/// Number in the name of initArgs_N.h5, so that 10 follows 9.
std::pair<std::size_t, std::string> rank_of(std::string const& file) { return {file.size(), file}; }

}  // namespace

void find_known_tool(std::vector<std::string> const& names, Files& files) {
    for (std::string const& name : names) {
        if (is_of_openmichrom(name) && files.tool.empty()) files.tool = openmichrom;
        for (char const* const prefix : {"initArgs_", "applied_forces_", "blocks_"})
            if (is_named(name, prefix)) files.tool = polychrom;
        if (is_named(name, "initArgs_") &&
            (files.init_args.empty() || rank_of(files.init_args) < rank_of(name)))
            files.init_args = name;
    }
}

std::string how_to_write(std::string const& tool) {
    std::string const object = tool.empty() ? "simulation" : "sim";
    return "write it in " + (tool.empty() ? "your" : tool + "'s") +
           " script, once its Context exists: from openmm import XmlSerializer as X; "
           "open('system.xml', 'w').write(X.serialize(" +
           object + ".system)); open('state.xml', 'w').write(X.serialize(" + object +
           ".context.getState(getPositions=True)))";
}

std::optional<OtherFiles> other_files(std::vector<std::string> const& files) {
    for (Program const& program : programs)
        for (fs::path const file : files)
            if (program.has(file))
                return OtherFiles{program.what, file.filename().string(), program.remedy(file)};
    return std::nullopt;
}

bool is_in_nanometres(std::string const& tool, std::vector<PdbChain> const& chains) {
    if (tool != openmichrom && tool != polychrom) return false;
    double sum = 0;
    std::size_t pairs = 0;
    for (PdbChain const& chain : chains)
        for (std::size_t k = 1; k < chain.size(); ++k, ++pairs)
            sum += norm(chain.position[k] - chain.position[k - 1]);
    return pairs > 0 && sum < longest_tenth * static_cast<double>(pairs);
}

}  // namespace catena::foreign
