// Implements the choice of the start.
#include "foreign/start_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "error.hpp"
#include "foreign/known_tools.hpp"
#include "foreign/system_text.hpp"
#include "scene/files.hpp"
#include "scene/node.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

/// A topology with its chains, or the reason why it cannot be read.
struct Candidate {
    std::string file;
    std::vector<PdbChain> chains = {};
    std::string fault = {};

    std::size_t atoms() const {
        std::size_t sum = 0;
        for (PdbChain const& chain : chains) sum += chain.size();
        return sum;
    }
    std::string name() const { return bare_names({file}); }
    /// Returns "a.pdb (10 atoms)".
    std::string size() const {
        return fault.empty()
                   ? fmt::format("{} ({} atom{})", name(), atoms(), atoms() == 1 ? "" : "s")
                   : fmt::format("{} (cannot be read)", name());
    }
};

Candidate read_candidate(std::string const& file) {
    try {
        return {file, read_pdb_topology(file, file)};
    } catch (InputError const& error) {
        return {file, {}, error.what()};
    }
}

/// "a.pdb (10 atoms), b.pdb (20 atoms)".
std::string sizes(std::vector<Candidate> const& candidates) {
    std::vector<std::string> each;
    for (Candidate const& one : candidates) each.push_back(one.size());
    return fmt::format("{}", fmt::join(each, ", "));
}

/// Throws InputError for a topology that cannot be read, or whose atoms are not the particles. A
/// System that is damaged is named instead: its particles cannot be counted.
void refuse_unfit(Candidate const& topology, Files const& files, std::string const& remedy) {
    if (!topology.fault.empty()) throw InputError(topology.fault);
    SystemText const system(files.system);
    if (topology.atoms() == system.particles()) return;
    system.refuse_damaged();
    throw InputError(
        fmt::format("the topology has {} atom{} and the System {} particles", topology.atoms(),
                    topology.atoms() == 1 ? "" : "s", system.particles()),
        scene::shown_path(topology.file), remedy);
}

/// Throws InputError if a file that promises a State by its name holds none.
void refuse_no_state(Contents const& contents) {
    if (contents.no_states.empty()) return;
    throw InputError("the file holds no serialised State",
                     scene::shown_path(contents.no_states.front()),
                     "write it with OpenMM's XmlSerializer.serialize(context.getState("
                     "positions=True)), or name the start's file after the folder or System");
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
    if (contents.states.size() != 1) {
        refuse_no_state(contents);
        throw InputError(
            fmt::format("{} writes nanometres where a PDB file has angstrom", files.tool),
            scene::shown_path(topology.file),
            fmt::format("leave one State in the folder, whose positions count; {}",
                        how_to_write(files.tool)));
    }
    take_state(&topology, contents.states.front(), files);
    files.notes.push_back(fmt::format(
        "The start has the positions of {}; {} has nanometres where a PDB file has angstrom.",
        bare_names(contents.states), topology.name()));
    return true;
}

/// Takes the only State where no topology fits. Throws InputError if that does not decide.
void take_state_instead(std::vector<Candidate> const& others, Contents const& contents,
                        Files& files) {
    char const* const remedy =
        "name the start's file after the folder or System, or serialise a State beside it";
    std::size_t const particles = SystemText(files.system).particles();
    if (contents.states.size() != 1) {
        refuse_no_state(contents);
        if (others.size() == 1)
            refuse_unfit(others.front(), files,
                         "give one atom per particle, in the System's order, or serialise a State "
                         "beside it");
        throw InputError(fmt::format("no topology of the folder has the System's {} particles: {}",
                                     particles, sizes(others)),
                         scene::shown_path(files.folder), remedy);
    }
    take_state(nullptr, contents.states.front(), files);
    files.notes.push_back(fmt::format(
        "The start is {}. Not read {} {}: the System has {} particles.",
        bare_names(contents.states), others.size() == 1 ? "is" : "are", sizes(others), particles));
}

/// Takes the only topology with as many atoms as the System has particles, else the only State.
/// Throws InputError if neither decides.
void take_fitting(Contents const& contents, Files& files) {
    std::size_t const particles = SystemText(files.system).particles();
    std::vector<Candidate> fitting, others;
    for (std::string const& file : contents.topologies) {
        Candidate one = read_candidate(file);
        (one.atoms() == particles ? fitting : others).push_back(std::move(one));
    }
    if (fitting.empty()) return take_state_instead(others, contents, files);
    if (fitting.size() > 1)
        throw InputError(
            fmt::format("{} topologies of the folder have the System's {} particles: {}",
                        fitting.size(), particles, sizes(fitting)),
            scene::shown_path(files.folder), "name one after the folder or System");
    if (!others.empty())
        files.notes.push_back(fmt::format(
            "The topology is {}. Not read {} {}: the System has {} particles.", sizes(fitting),
            others.size() == 1 ? "is" : "are", sizes(others), particles));
    if (take_in_nanometres(fitting.front(), contents, files)) return;
    files.topology = fitting.front().file;
}

/// Takes the folder's only topology for the chains of a named State, unless it does not fit.
void take_chains(Contents const& contents, Files& files) {
    if (contents.topologies.size() != 1) return;
    Candidate const topology = read_candidate(contents.topologies.front());
    std::size_t const particles = SystemText(files.system).particles();
    if (topology.atoms() == particles) {
        files.topology = topology.file;
        return;
    }
    files.notes.push_back(
        fmt::format("The bonds tell the chains. Not read is {}: the System has {} particles.",
                    topology.size(), particles));
}

/// Notes States that are not the start, and files that are no State in spite of their name.
void note_other_states(Contents const& contents, Files& files) {
    if (!files.state.empty()) return;
    if (!contents.states.empty())
        files.notes.push_back(fmt::format(
            "{} is not read: the start is that of {} (name the State after the folder or System to "
            "start from it).",
            bare_names(contents.states), bare_names({files.topology})));
    if (!contents.no_states.empty())
        files.notes.push_back(fmt::format("{} holds no serialised State: the start is that of {}.",
                                          bare_names(contents.no_states),
                                          bare_names({files.topology})));
}

}  // namespace

void take_named_start(std::string const& named, Contents const& contents, Files& files) {
    std::error_code ignored;
    fs::path path = named;
    if (!fs::is_regular_file(path, ignored)) path = fs::path(files.folder) / named;
    if (!fs::is_regular_file(path, ignored))
        throw InputError("no such file", scene::shown_path(named),
                         "name a PDB or mmCIF file, or a serialised State");
    if (scene::ending_of(path.string()) != ".xml") {
        if (take_in_nanometres(read_candidate(path.string()), contents, files)) return;
        files.topology = path.string();
        refuse_unfit_topology(files, "give one atom per particle, in the System's order");
        return;
    }
    if (root_of(path) != "State")
        throw InputError("the file is not a serialised State", scene::shown_path(path.string()),
                         "name a PDB or mmCIF file, or a State with positions");
    files.state = path.string();
    take_chains(contents, files);
}

void take_only_start(Contents const& contents, Files& files) {
    if (!contents.topologies.empty()) {
        take_fitting(contents, files);
    } else if (contents.states.size() == 1) {
        files.state = contents.states.front();
    } else {
        refuse_no_state(contents);
        throw InputError(contents.states.empty()
                             ? "the folder holds no topology (PDB, mmCIF) and no State"
                             : fmt::format("the folder holds {} States: {}", contents.states.size(),
                                           bare_names(contents.states)),
                         scene::shown_path(files.folder),
                         "name the start's file after the folder or System");
    }
    note_other_states(contents, files);
}

void refuse_unfit_topology(Files const& files, std::string const& remedy) {
    refuse_unfit(read_candidate(files.topology), files, remedy);
}

}  // namespace catena::foreign
