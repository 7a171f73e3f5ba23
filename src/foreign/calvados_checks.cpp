// Implements the comparison of the package's files. The package (version 0.8, calvados/sim.py)
// makes the System of config.yaml and components.yaml, one chain for each molecule.
#include "foreign/calvados_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "error.hpp"
#include "foreign/calvados_charges.hpp"
#include "foreign/calvados_forces.hpp"
#include "foreign/system_text.hpp"
#include "io/output_file.hpp"
#include "scene/fields.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

constexpr double most_box_difference = 1e-4;  // nm
/// Key with which a configuration of the package ends: its keys are in alphabetical order.
constexpr char const* last_key = "wfreq";
/// Number of keys in alphabetical order from which a file is taken for the package's own.
constexpr std::ptrdiff_t least_keys = 5;
constexpr char const* write_again = "write it again with the package's prepare.py";

/// Name of a file without its folder, for messages.
std::string bare_name(std::string const& file) {
    return scene::shown_path(std::filesystem::path(file).filename().string());
}

/// Throws InputError if the configuration's box is not the System's.
void refuse_another_size(PackageFile const& config, SystemText const& system) {
    Node const* const node = config.find("box");
    std::optional<Vec3> const made = system.box();
    if (node == nullptr || !made) return;
    Vec3 const asked = scene::vector3(*node);
    for (int k = 0; k < 3; ++k)
        if (std::abs(asked[k] - (*made)[k]) > most_box_difference)
            scene::fail(*node,
                        fmt::format("the box is {:.6g} x {:.6g} x {:.6g} nm, that of {} {:.6g} x "
                                    "{:.6g} x {:.6g} nm",
                                    asked[0], asked[1], asked[2], bare_name(system.file()),
                                    (*made)[0], (*made)[1], (*made)[2]),
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
                                  {"box_eq", "MonteCarloAnisotropicBarostat", false},
                                  {"bilayer_eq", "MonteCarloMembraneBarostat", true}}) {
        bool const may_lack = force.of_equilibration && is_continued;
        if (!config.truth(force.key) || may_lack || system.holds(force.kind)) continue;
        scene::fail(*config.find(force.key),
                    fmt::format("`{}` is true, but {} has no {}", force.key,
                                bare_name(system.file()), force.kind),
                    fmt::format("start the package's run.py again, which writes the System, or "
                                "write `{}: false`",
                                force.key));
    }
}

/// Notes an external force that the configuration does not ask for: a pull towards a slab, say,
/// would act throughout.
void note_unasked_force(PackageFile const& config, SystemText const& system, Settings& settings) {
    char const* const kind = "CustomExternalForce";
    if (!system.holds(kind) || config.truth("slab_eq") || config.truth("ext_force")) return;
    settings.notes.push_back(fmt::format(
        "{} has a {} that config.yaml does not ask for (slab_eq, ext_force): it acts throughout. "
        "If it should not, import with --leave-out {}.",
        bare_name(system.file()), kind, kind));
}

/// Last line of a text that does not end with a line feed; empty for others.
std::string open_line(std::string const& text) {
    std::size_t const feed = text.rfind('\n');
    return feed == std::string::npos ? text : text.substr(feed + 1);
}

/// Adds one component. Its properties override the defaults.
void add_component(Node const& component, PackageFile const& file, Node const* defaults,
                   CalvadosComponents& sum) {
    if (component.kind != Node::Kind::map)
        throw InputError(
            fmt::format("component `{}` has no properties", scene::shown(component.key)),
            scene::shown_path(file.root().text),
            std::string(write_again) + ", or move it out of the folder");
    auto const property = [&](char const* key) -> Node const* {
        Node const* const own = component.find(key);
        return own != nullptr || defaults == nullptr ? own : defaults->find(key);
    };
    Node const* const copies = valued(property("nmol"));
    sum.molecules += copies == nullptr ? 1 : whole_of(*copies, 0);
    auto const word = [&](char const* key, char const* otherwise) {
        Node const* const node = valued(property(key));
        return node == nullptr ? std::string(otherwise) : scene::text(*node);
    };
    auto const stiffness = [&](char const* key, double otherwise) {
        Node const* const node = valued(property(key));
        sum.stiffness.insert(node == nullptr ? otherwise : scene::number(*node));
    };
    sum.proteins = sum.proteins && word("molecule_type", "protein") == "protein";
    ++sum.harmonic_forces;
    stiffness("kb", 8033);
    Node const* const restraint = valued(property("restraint"));
    if (restraint == nullptr || !scene::truth(*restraint)) return;
    sum.restrained = true;
    if (word("restraint_type", "harmonic") == "go")
        sum.custom_forces += 3;  // contacts, scaled contacts and scaled charges
    else
        ++sum.harmonic_forces, stiffness("k_harmonic", 700);
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

void check_configuration(PackageFile const& config, Files const& files, bool is_continued,
                         Settings& settings) {
    SystemText const system(files.system);
    refuse_another_size(config, system);
    refuse_other_charges(config, files, settings.notes);
    refuse_lost_forces(config, system, is_continued);
    refuse_other_forces(config, system);
    if (config.truth("pressure_coupling"))
        settings.notes.push_back(
            "`pressure_coupling` is not taken over: the scene has a constant volume.");
    note_unasked_force(config, system, settings);
    if (settings.steps > 0 && settings.every > settings.steps)
        settings.notes.push_back(
            fmt::format("config.yaml has wfreq {} and {} steps: the package would write no frame, "
                        "the scene writes one at its end.",
                        settings.every, settings.steps));
}

CalvadosComponents read_components(std::string const& file) {
    PackageFile const components(file);
    Node const* const system = components.find("system");
    if (system == nullptr || system->kind != Node::Kind::map || system->items.empty())
        throw InputError("the file has no components under `system`", scene::shown_path(file),
                         std::string(write_again) + ", or move it out of the folder");
    Node const* const defaults = components.find("defaults");
    CalvadosComponents sum;
    for (Node const& component : system->items) add_component(component, components, defaults, sum);
    return sum;
}

void refuse_other_molecules(CalvadosComponents const& components, Files const& files) {
    if (files.topology.empty()) return;
    auto const chains =
        static_cast<std::int64_t>(read_pdb_topology(files.topology, files.topology).size());
    // A complex, which only structures give, has several chains once its ends have a TER.
    if (chains == components.molecules || (components.restrained && chains > components.molecules))
        return;
    throw InputError(
        fmt::format("the components make {} molecule{}, and {} has {} chain{}",
                    components.molecules, components.molecules == 1 ? "" : "s",
                    bare_name(files.topology), chains, chains == 1 ? "" : "s"),
        scene::shown_path(files.components),
        std::string(write_again) + ", or move it out of the folder if it is of another System");
}

}  // namespace catena::foreign
