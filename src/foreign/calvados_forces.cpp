// Implements the comparison of forces. The package (version 0.8, calvados/interactions.py and
// calvados/components.py) writes numbers into expressions and one force of bonds per component.
#include "foreign/calvados_forces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <regex>
#include <set>

#include "error.hpp"
#include "scene/fields.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

constexpr double most_part = 1e-6;  // relative difference of numbers that are written in full
constexpr double kilocalorie = 4.184;
constexpr std::size_t longest_energy = 1000;  // characters of an expression of contacts

std::string name_of(SystemText const& system) {
    return scene::shown_path(std::filesystem::path(system.file()).filename().string());
}

bool are_equal(double a, double b) {
    return std::abs(a - b) <= most_part * std::max(std::abs(a), std::abs(b));
}

/// Throws InputError if the key has another value than the System.
void refuse_another(PackageFile const& config, char const* key, double made, double unit,
                    SystemText const& system) {
    Node const* const node = config.find(key);
    if (node == nullptr || are_equal(scene::number(*node) * unit, made)) return;
    scene::fail(*node,
                fmt::format("`{}` is {:.6g}, and {} was written with {:.6g}", key,
                            scene::number(*node), name_of(system), made / unit),
                run_again);
}

/// Compares the numbers in the expression of contacts.
void refuse_other_contacts(PackageFile const& config, SystemText const& system) {
    static std::regex const form(
        R"(([^*]+)\*select\(step\(r-2\^\(1/6\)\*s\).*)"
        R"(l=select\(id1\+id2,\(id1\*id2\)\*0\.5\*\(l1\+l2\),([^)]+)\);\s*shift=\(s/([^)]+)\)\^12.*)");
    struct Number {
        char const* key;
        std::size_t group;
        double unit;
    };
    for (ForceText const& force : system.forces()) {
        std::smatch parts;
        bool const is_contact = force.kind == "CustomNonbondedForce" &&
                                force.energy.size() < longest_energy &&
                                std::regex_match(force.energy, parts, form);
        if (!is_contact) continue;
        for (Number const& number :
             {Number{"eps_lj", 1, kilocalorie}, {"fixed_lambda", 2, 1}, {"cutoff_lj", 3, 1}}) {
            double made = 0;
            if (scene::parse_number(parts[number.group].str(), made) == scene::NumberFault::none)
                refuse_another(config, number.key, made, number.unit, system);
        }
    }
}

std::string without_spaces(std::string text) {
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n' || c == '\t'; });
    return text;
}

/// Compares the external force with the one that the configuration asks for.
void refuse_another_pull(PackageFile const& config, SystemText const& system) {
    bool const slab = config.truth("slab_eq"), own = config.truth("ext_force");
    Node const* const expression = config.find("ext_force_expr");
    for (ForceText const& force : system.forces()) {
        if (force.kind != "CustomExternalForce" || slab == own) continue;
        auto const k = force.globals.find("k");
        if (slab && k != force.globals.end()) refuse_another(config, "k_eq", k->second, 1, system);
        if (own && expression != nullptr &&
            without_spaces(scene::text(*expression)) != without_spaces(force.energy))
            scene::fail(*expression,
                        fmt::format("`ext_force_expr` is not the CustomExternalForce of {}, `{}`",
                                    name_of(system), scene::shown(force.energy)),
                        run_again);
    }
}

/// Numbers of forces of bonds, and the stiffnesses of their harmonic bonds, kJ/mol/nm2.
struct BondForces {
    std::int64_t harmonic = 0, custom = 0;
    std::set<double> stiffness;
};

BondForces bond_forces_of(SystemText const& system) {
    BondForces found;
    for (ForceText const& force : system.forces()) {
        found.custom += force.kind == "CustomBondForce" ? 1 : 0;
        found.harmonic += force.kind == "HarmonicBondForce" ? 1 : 0;
        found.stiffness.insert(force.stiffness.begin(), force.stiffness.end());
    }
    return found;
}

/// "1 HarmonicBondForce and 0 CustomBondForces".
std::string counted(BondForces const& forces) {
    return fmt::format("{} HarmonicBondForce{} and {} CustomBondForce{}", forces.harmonic,
                       forces.harmonic == 1 ? "" : "s", forces.custom,
                       forces.custom == 1 ? "" : "s");
}

}  // namespace

void refuse_other_forces(PackageFile const& config, SystemText const& system) {
    refuse_other_contacts(config, system);
    refuse_another_pull(config, system);
}

void refuse_other_bonds(PackageFile const& config, CalvadosComponents const& components,
                        SystemText const& system, std::string const& components_file,
                        std::vector<std::string>& notes) {
    if (!components.proteins) return;
    BondForces made{components.harmonic_forces, components.custom_forces, {}};
    bool const own = config.truth("custom_restraints");
    if (own)
        ++(config.text("custom_restraint_type", "harmonic") == "go" ? made.custom : made.harmonic);
    BondForces const found = bond_forces_of(system);
    std::string const where = scene::shown_path(components_file);
    if (found.harmonic < made.harmonic || found.custom < made.custom)
        throw InputError(
            fmt::format("the components, their `restraint` and `custom_restraints` of config.yaml "
                        "make {}, and {} has {}",
                        counted(made), name_of(system), counted(found)),
            where, run_again);
    if (found.harmonic > made.harmonic || found.custom > made.custom)
        return notes.push_back(fmt::format(
            "{} has {}, where the components, their `restraint` and `custom_restraints` make {}: "
            "the others act, too.",
            name_of(system), counted(found), counted(made)));
    for (double const k : found.stiffness)
        if (!own && std::none_of(components.stiffness.begin(), components.stiffness.end(),
                                 [&](double known) { return are_equal(k, known); }))
            throw InputError(
                fmt::format("bonds of {} have a stiffness of {:.6g} kJ/mol/nm2, those of the "
                            "components (`kb`, `k_harmonic`) {:.6g}",
                            name_of(system), k, fmt::join(components.stiffness, ", ")),
                where, run_again);
}

}  // namespace catena::foreign
