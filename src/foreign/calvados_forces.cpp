// Implements the comparison of forces. The package (version 0.8, calvados/interactions.py and
// calvados/components.py) writes numbers into expressions and one force of bonds per component.
#include "foreign/calvados_forces.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <regex>
#include <utility>

#include "error.hpp"
#include "scene/fields.hpp"

namespace catena::foreign {

namespace {

constexpr double kilocalorie = 4.184;
constexpr std::size_t longest_energy = 1000;  // characters of an expression of contacts
constexpr double with_rounding = 1 + 1e-6;    // factor for limits that are written in full
constexpr int forces_of_go = 3;               // contacts, scaled contacts and scaled charges
constexpr int scaled_contacts_of_go = 1;

/// Matches the expression of contacts in the package's form.
bool match_contacts(ForceText const& force, std::smatch& parts) {
    static std::regex const form(
        R"(([^*]+)\*select\(step\(r-2\^\(1/6\)\*s\).*)"
        R"(l=select\(id1\+id2,\(id1\*id2\)\*0\.5\*\(l1\+l2\),([^)]+)\);\s*shift=\(s/([^)]+)\)\^12.*)");
    return force.kind == "CustomNonbondedForce" && force.energy.size() < longest_energy &&
           std::regex_match(force.energy, parts, form);
}

/// Forces of bonds that components and custom restraints make, or that a System has.
struct BondForces {
    std::int64_t harmonic = 0, custom = 0;
};

BondForces bond_forces_of(SystemText const& system) {
    BondForces found;
    for (ForceText const& force : system.forces()) {
        found.custom += force.kind == "CustomBondForce" ? 1 : 0;
        found.harmonic += force.kind == "HarmonicBondForce" ? 1 : 0;
    }
    return found;
}

BondForces bond_forces_of(PackageFile const& config, CalvadosComponents const& components) {
    BondForces made;
    for (CalvadosComponent const& component : components.all) {
        ++made.harmonic;
        if (component.is_rna()) ++made.custom;  // stacked bases
        if (component.is_go())
            made.custom += forces_of_go;
        else if (component.restrained)
            ++made.harmonic;
    }
    if (config.truth("custom_restraints"))
        ++(config.text("custom_restraint_type", "harmonic") == "go" ? made.custom : made.harmonic);
    return made;
}

/// "1 HarmonicBondForce and 0 CustomBondForces".
std::string counted(BondForces const& forces) {
    return fmt::format("{} HarmonicBondForce{} and {} CustomBondForce{}", forces.harmonic,
                       forces.harmonic == 1 ? "" : "s", forces.custom,
                       forces.custom == 1 ? "" : "s");
}

/// Compares bonds with components.
class BondCheck {
  public:
    BondCheck(CalvadosComponents const& components, SystemText const& system)
        : components_(components), system_(system) {}

    void compare() const {
        for (ComponentForces const& of : forces_of(components_, system_)) {
            CalvadosComponent const& component = *of.component;
            if (component.is_rna())
                compare_rna(component, of);
            else if (of.bonds != nullptr)
                refuse_stiffness(component, *of.bonds, "kb", component.kb);
            if (of.networks.empty() || of.networks[0] == nullptr) continue;
            if (component.is_go()) {
                refuse_beyond(component, *of.networks[0], component.k_go);
            } else {
                refuse_stiffness(component, *of.networks[0], "k_harmonic", component.k_harmonic);
                refuse_beyond(component, *of.networks[0], component.k_harmonic);
            }
        }
    }

  private:
    /// Compares bonds, stacked bases and angles of RNA. Restraints change lengths and angles.
    void compare_rna(CalvadosComponent const& rna, ComponentForces const& of) const {
        RnaParameters const& parameters = rna.rna;
        if (of.bonds != nullptr)
            for (BondText const& bond : of.bonds->bonds) {
                bool const is_base = bond.second == bond.first + 1;
                refuse_other(rna, {"bonds", "a stiffness", "kJ/mol/nm2"}, bond.stiffness,
                             is_base ? "rna_kb2" : "rna_kb1",
                             is_base ? parameters.kb2 : parameters.kb1);
            }
        if (ForceText const* const stacks = of.stacks) {
            auto const cutoff = stacks->globals.find("rc");
            if (cutoff != stacks->globals.end())
                refuse_other(rna, {"stacked bases", "a cutoff", "nm"}, cutoff->second,
                             "rna_nb_cutoff", parameters.nb_cutoff);
            for (BondText const& pair : stacks->bonds) {
                refuse_other(rna, {"stacked bases", "a factor", ""}, pair.third, "rna_nb_scale",
                             parameters.nb_scale);
                if (!rna.restrained)
                    refuse_other(rna, {"stacked bases", "a diameter", "nm"}, pair.length,
                                 "rna_nb_sigma", parameters.nb_sigma);
            }
        }
        if (ForceText const* const angles = of.angles)
            for (BondText const& angle : angles->bonds) {
                refuse_other(rna, {"angles", "a stiffness", "kJ/mol/rad2"}, angle.stiffness,
                             "rna_ka", parameters.ka);
                if (!rna.restrained)
                    refuse_other(rna, {"angles", "a rest angle", "rad"}, angle.length, "rna_pa",
                                 parameters.pa);
            }
    }

    /// Names of a compared number, for messages: "bonds" have "a stiffness" in "kJ/mol/nm2".
    struct Property {
        char const *of, *name, *unit;
    };
    void refuse_other(CalvadosComponent const& component, Property const& what, double found,
                      char const* key, double asked) const {
        if (are_equal(found, asked)) return;
        throw InputError(
            fmt::format("{} of {} have {} of {:.6g}{}{}, those of `{}` (`{}`) {:.6g}", what.of,
                        system_.name(), what.name, found, *what.unit == '\0' ? "" : " ", what.unit,
                        scene::shown(component.name), key, asked),
            components_.place(component, key), run_again);
    }

    void refuse_stiffness(CalvadosComponent const& component, ForceText const& force,
                          char const* key, double asked) const {
        for (BondText const& bond : force.bonds)
            refuse_other(component, {"bonds", "a stiffness", "kJ/mol/nm2"}, bond.stiffness, key,
                         asked);
    }

    /// Throws InputError for a pair of a network that is farther apart or bound more strongly than
    /// its component allows.
    void refuse_beyond(CalvadosComponent const& component, ForceText const& force,
                       double strongest) const {
        for (auto const& [length, k, i, j, third] : force.bonds) {
            if (length > component.cutoff_restr * with_rounding)
                throw InputError(fmt::format("the network of `{}` joins pairs up to {:.6g} nm "
                                             "(`cutoff_restr`), and {} has one of {:.6g} nm",
                                             scene::shown(component.name), component.cutoff_restr,
                                             system_.name(), length),
                                 components_.place(component, "cutoff_restr"), run_again);
            if (k > strongest * with_rounding)
                throw InputError(
                    fmt::format("contacts of `{}` have a depth of at most {:.6g} "
                                "kJ/mol (`k_go`), and {} has one of {:.6g}",
                                scene::shown(component.name), strongest, system_.name(), k),
                    components_.place(component, "k_go"), run_again);
        }
    }

    CalvadosComponents const& components_;
    SystemText const& system_;
};

}  // namespace

std::vector<ComponentForces> forces_of(CalvadosComponents const& components,
                                       SystemText const& system) {
    std::map<std::string, std::size_t> after;  // one past the last force of each kind so far
    auto const next = [&](std::string const& kind) -> ForceText const* {
        std::vector<ForceText> const& forces = system.forces();
        for (std::size_t& at = after[kind]; at < forces.size();)
            if (ForceText const& force = forces[at++]; force.kind == kind) return &force;
        return nullptr;
    };
    std::vector<ComponentForces> found;
    for (CalvadosComponent const& component : components.all) {
        ComponentForces of{&component, next("HarmonicBondForce")};
        if (component.is_rna())
            of.stacks = next("CustomBondForce"), of.angles = next("HarmonicAngleForce");
        if (component.is_go())
            for (int i = 0; i < forces_of_go; ++i) of.networks.push_back(next("CustomBondForce"));
        else if (component.restrained)
            of.networks.push_back(next("HarmonicBondForce"));
        found.push_back(std::move(of));
    }
    return found;
}

namespace {

/// Compares global parameters of stacked bases or scaled contacts with config.yaml. RNA has a
/// cutoff of its own.
void compare_globals(PackageFile const& config, ForceText const* force,
                     std::vector<std::string> const& names, std::string const& system) {
    if (force == nullptr) return;
    for (std::string const& name : names) {
        auto const found = force->globals.find(name);
        if (found == force->globals.end()) continue;
        bool const depth = name == "eps";
        refuse_another(config, depth ? "eps_lj" : "cutoff_lj", found->second,
                       depth ? kilocalorie : 1, system);
    }
}

}  // namespace

ForceText const* contacts_of(SystemText const& system) {
    std::smatch parts;
    for (ForceText const& force : system.forces())
        if (match_contacts(force, parts)) return &force;
    return nullptr;
}

void compare_contacts(PackageFile const& config, SystemText const& system,
                      std::vector<std::string>& notes) {
    struct Number {
        char const* key;
        std::size_t group;
        double unit;
    };
    bool found = false;
    for (ForceText const& force : system.forces()) {
        std::smatch parts;
        if (!match_contacts(force, parts)) continue;
        found = true;
        refuse_another(config, "cutoff_lj", force.cutoff, 1, system.name());
        for (Number const& number :
             {Number{"eps_lj", 1, kilocalorie}, {"fixed_lambda", 2, 1}, {"cutoff_lj", 3, 1}}) {
            double made = 0;
            if (scene::parse_number(parts[number.group].str(), made) == scene::NumberFault::none)
                refuse_another(config, number.key, made, number.unit, system.name());
        }
    }
    if (!found)
        notes.push_back(fmt::format(
            "No contacts of the package's form are found in {}: whether `eps_lj`, `cutoff_lj` and "
            "`fixed_lambda` are those of its run is not checked.",
            system.name()));
}

void compare_bonds(PackageFile const& config, CalvadosComponents const& components,
                   std::string const& folder, MadeSystem const& made_system,
                   std::vector<std::string>& notes) {
    SystemText const& system = made_system.text;
    if (!components.comparable())
        return notes.push_back(fmt::format(
            "{} has molecules other than proteins, RNA and crowders (`molecule_type`): whether the "
            "other properties of components are those of {} is not checked.",
            "components.yaml", system.name()));
    BondForces const made = bond_forces_of(config, components), found = bond_forces_of(system);
    if (found.harmonic < made.harmonic || found.custom < made.custom)
        throw InputError(
            fmt::format("the components, their `restraint` and `custom_restraints` of config.yaml "
                        "make {}, and {} has {}",
                        counted(made), system.name(), counted(found)),
            components.file, run_again);
    if (found.harmonic > made.harmonic || found.custom > made.custom)
        return notes.push_back(fmt::format(
            "{} has {}, where the components, their `restraint` and `custom_restraints` make {}: "
            "the others act, too.",
            system.name(), counted(found), counted(made)));
    BondCheck(components, system).compare();
    for (ComponentForces const& of : forces_of(components, system)) {
        compare_globals(config, of.stacks, {"eps"}, system.name());
        if (of.networks.size() == forces_of_go)
            compare_globals(config, of.networks[scaled_contacts_of_go], {"eps", "rc"},
                            system.name());
    }
    compare_networks(config, components, folder, made_system, notes);
}

}  // namespace catena::foreign
