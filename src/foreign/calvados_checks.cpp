// Implements the comparison of the package's files. The package (version 0.8, calvados/sim.py)
// makes the System of config.yaml and components.yaml, one chain for each molecule.
#include "foreign/calvados_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "error.hpp"
#include "foreign/calvados_charges.hpp"
#include "foreign/calvados_components.hpp"
#include "foreign/calvados_forces.hpp"
#include "foreign/calvados_keys.hpp"
#include "foreign/calvados_tables.hpp"
#include "foreign/contents.hpp"
#include "foreign/made_system.hpp"
#include "io/output_file.hpp"
#include "scene/fields.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

constexpr double most_box_difference = 1e-4;  // nm
/// Key with which a configuration of the package ends: its keys are in alphabetical order.
constexpr char const* last_key = "wfreq";
/// Number of keys in alphabetical order from which a file is taken for the package's own.
constexpr std::ptrdiff_t least_keys = 5;

/// Throws InputError if the configuration's box is not the System's.
void refuse_another_size(PackageFile const& config, SystemText const& system) {
    Node const* const node = config.find("box");
    std::optional<Vec3> const made = system.box();
    if (node == nullptr || !made) return;
    if (node->kind != Node::Kind::list || node->items.size() != 3)
        scene::fail(*node, "`box` has other than three edges", "write three numbers in nm");
    Vec3 asked;
    for (int k = 0; k < 3; ++k) asked[k] = number_of(node->items[static_cast<std::size_t>(k)]);
    for (int k = 0; k < 3; ++k)
        if (std::abs(asked[k] - (*made)[k]) > most_box_difference)
            scene::fail(*node,
                        fmt::format("the box is {:.6g} x {:.6g} x {:.6g} nm, that of {} {:.6g} x "
                                    "{:.6g} x {:.6g} nm",
                                    asked[0], asked[1], asked[2], system.name(), (*made)[0],
                                    (*made)[1], (*made)[2]),
                        "start the package's run.py again, which writes the System, or correct "
                        "`box`");
}

/// A key of the configuration that makes a force of the System.
struct ForceKey {
    char const *key, *kind;
    /// True if the force is absent from Systems of continued runs.
    bool of_equilibration;
};

/// Throws InputError if the System lacks a force that the configuration asks for.
void refuse_lost_forces(PackageFile const& config, SystemText const& system, bool is_continued) {
    for (ForceKey const& force : {ForceKey{"slab_eq", "CustomExternalForce", true},
                                  {"ext_force", "CustomExternalForce", false},
                                  {"box_eq", "MonteCarloAnisotropicBarostat", true},
                                  {"bilayer_eq", "MonteCarloMembraneBarostat", true}}) {
        bool const may_lack = force.of_equilibration && is_continued;
        if (!config.truth(force.key) || may_lack || system.holds(force.kind)) continue;
        scene::fail(
            *config.find(force.key),
            fmt::format("`{}` is true, but {} has no {}", force.key, system.name(), force.kind),
            fmt::format("start the package's run.py again, which writes the System, or "
                        "write `{}: false`",
                        force.key));
    }
}

/// Last line of a text that does not end with a line feed; empty for others.
std::string open_line(std::string const& text) {
    std::size_t const feed = text.rfind('\n');
    return feed == std::string::npos ? text : text.substr(feed + 1);
}

}  // namespace

void refuse_cut(PackageFile const& config, std::vector<std::string>& notes) {
    std::string const& file = config.root().text;
    std::string const line = open_line(read_text_file(file)), last = last_key;
    std::size_t const end = line.find_last_not_of(" \t\r");
    if (end != std::string::npos && line[end] == ':')
        throw InputError(
            fmt::format("the configuration ends within its last line, `{}`", scene::shown(line)),
            scene::shown_path(file), fmt::format("{}, or give that key a value", write_again));
    std::vector<std::string> keys;
    for (Node const& item : config.root().items) keys.push_back(item.key);
    if (config.root().find(last) == nullptr && std::ssize(keys) >= least_keys &&
        std::is_sorted(keys.begin(), keys.end()))
        throw InputError(fmt::format("the configuration ends with `{}`, where the package's ends "
                                     "with `{}`: it was cut",
                                     scene::shown(keys.back()), last),
                         scene::shown_path(file),
                         fmt::format("{}, or add `{}`", write_again, last));
    if (end != std::string::npos)
        notes.push_back(fmt::format(
            "config.yaml ends with `{}` and without a line feed: see that no digit is missing.",
            scene::shown(line)));
}

namespace {

/// Notes what the package does with the box and the scene does not.
void note_barostat(PackageFile const& config, std::vector<std::string>& notes) {
    if (config.truth("pressure_coupling"))
        notes.push_back("`pressure_coupling` is not taken over: the scene has a constant volume.");
    for (char const* const key : {"box_eq", "bilayer_eq"})
        if (config.truth(key))
            notes.push_back(
                fmt::format("`{}` is true: the package's equilibration changes the box, and the "
                            "scene keeps the one it starts with.",
                            key));
}

/// Notes compared keys that the configuration lacks, so that the System's values count.
void note_absent(PackageFile const& config, std::string const& system,
                 std::vector<std::string>& notes) {
    std::vector<std::string> absent;
    for (char const* const key :
         {"box", "cutoff_lj", "cutoff_yu", "eps_lj", "fixed_lambda", "ionic"})
        if (config.find(key) == nullptr) absent.emplace_back(key);
    if (!absent.empty())
        notes.push_back(
            fmt::format("config.yaml has no {}: {} decides.", fmt::join(absent, ", "), system));
}

/// Throws InputError if the topology does not have one chain for each molecule. It may have more if
/// molecules may be complexes of several chains.
void refuse_other_molecules(CalvadosComponents const& components, MadeSystem const& made,
                            std::vector<std::string>& notes) {
    auto const chains = std::ssize(made.chains);
    std::int64_t const molecules = components.molecules();
    if (chains == 0 || chains == molecules) return;
    if (!components.restrained() || chains < molecules)
        throw InputError(
            fmt::format("the components make {} molecule{}, and {} has {} chain{}", molecules,
                        molecules == 1 ? "" : "s", made.topology, chains, chains == 1 ? "" : "s"),
            components.file,
            std::string(write_again) + ", or move it out of the folder if it is of another System");
    // A complex, which only structures give, has several chains once its ends have a TER.
    if (components.all.size() > 1)
        notes.push_back(fmt::format(
            "{} has {} chains for {} molecules: whether `charge_termini`, "
            "`ext_restraint`, `ffasta` and `fresidues` are those of {}, and whether its "
            "molecules are alike, is not checked.",
            made.topology, chains, molecules, made.name()));
}

/// Positions in the folder's top.pdb; none if it is not there, cannot be read or is not of that
/// many particles.
std::vector<Vec3> first_start_in(std::string const& folder, std::size_t particles) {
    std::string const file = (std::filesystem::path(folder) / "top.pdb").string();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return {};
    std::vector<Vec3> positions;
    try {
        for (PdbChain const& chain : read_pdb_topology(file, file))
            positions.insert(positions.end(), chain.position.begin(), chain.position.end());
    } catch (InputError const&) {
        return {};
    }
    return positions.size() == particles ? positions : std::vector<Vec3>();
}

/// Sentence on restrained molecules. Only those of residues can be rigid bodies of Catena.
std::string network_note(CalvadosComponents const& components) {
    std::string const stay = "The package's elastic networks stay forces.";
    bool const rigid =
        std::any_of(components.all.begin(), components.all.end(),
                    [](CalvadosComponent const& c) { return c.restrained && !c.is_rna(); });
    return rigid ? stay + " To move domains as rigid bodies, write `chains` with `rigid`." : stay;
}

/// Compares components with the System and the topology.
void check_components(PackageFile const& config, PackageFile const& file, MadeSystem const& made,
                      Files const& files, std::vector<std::string>& notes) {
    CalvadosComponents const components = read_components(file);
    refuse_other_molecules(components, made, notes);
    compare_bonds(config, components, files.folder, made, notes);
    if (components.comparable()) {
        refuse_other_termini(config, components, made);
        refuse_other_pulled(config, components, made);
    }
    compare_tables(config, &components, files.folder, made, notes);
    if (components.restrained()) notes.push_back(network_note(components));
}

}  // namespace

std::optional<double> MadeSystem::distance(std::int64_t a, std::int64_t b) const {
    if (std::min(a, b) < 0 || std::max(a, b) >= std::ssize(first_start)) return std::nullopt;
    Vec3 apart =
        first_start[static_cast<std::size_t>(b)] - first_start[static_cast<std::size_t>(a)];
    if (std::optional<Vec3> const edges = text.box())
        for (int i = 0; i < 3; ++i)
            if ((*edges)[i] > 0) apart[i] -= (*edges)[i] * std::round(apart[i] / (*edges)[i]);
    return norm(apart);
}

MadeSystem read_made_system(Files const& files) {
    MadeSystem made{SystemText(files.system),
                    read_screened_chains(files.system, scene::shown_path(files.system)),
                    {},
                    bare_names({files.topology}),
                    {}};
    if (!files.topology.empty()) made.chains = read_pdb_topology(files.topology, files.topology);
    made.first_start = first_start_in(files.folder, made.text.particles());
    return made;
}

void check_package(PackageFile const& config, Files const& files, bool is_continued,
                   Settings& settings) {
    std::vector<std::string>& notes = settings.notes;
    MadeSystem const made = read_made_system(files);
    refuse_another_size(config, made.text);
    compare_charges(config, made, notes);
    refuse_lost_forces(config, made.text, is_continued);
    compare_contacts(config, made.text, notes);
    compare_pull(config, made.text, notes);
    note_barostat(config, notes);
    note_absent(config, made.name(), notes);
    if (settings.steps > 0 && settings.every > settings.steps)
        notes.push_back(
            fmt::format("config.yaml has wfreq {} and {} steps: the package would write no frame, "
                        "the scene writes one at its end.",
                        settings.every, settings.steps));
    std::optional<PackageFile> components;
    if (!files.components.empty()) components.emplace(files.components);
    if (components)
        check_components(config, *components, made, files, notes);
    else
        compare_tables(config, nullptr, files.folder, made, notes);
    note_keys(config, components ? &*components : nullptr, made.name(), notes);
}

}  // namespace catena::foreign
