// Implements the notes on keys. The keys are those of the package's calvados/inputmodels.py,
// calvados/data/default_config.yaml and calvados/data/default_component.yaml.
#include "foreign/calvados_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "scene/fields.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

constexpr std::array of_config = {
    PackageKey{"bilayer_eq", KeyUse::compared},
    PackageKey{"box", KeyUse::compared},
    PackageKey{"box_eq", KeyUse::compared},
    PackageKey{"boxscaling_xyz", KeyUse::barostat},
    PackageKey{"custom_restraint_type", KeyUse::compared},
    PackageKey{"custom_restraints", KeyUse::compared},
    PackageKey{"cutoff_lj", KeyUse::compared},
    PackageKey{"cutoff_yu", KeyUse::compared},
    PackageKey{"eps_lj", KeyUse::compared},
    PackageKey{"ext_force", KeyUse::compared},
    PackageKey{"ext_force_expr", KeyUse::compared},
    PackageKey{"fcustom_restraints", KeyUse::compared},
    PackageKey{"fixed_lambda", KeyUse::compared},
    PackageKey{"frestart", KeyUse::taken},
    PackageKey{"friction", KeyUse::taken},
    PackageKey{"friction_coeff", KeyUse::taken},
    PackageKey{"gpu_id", KeyUse::program},
    PackageKey{"ionic", KeyUse::compared},
    PackageKey{"k_eq", KeyUse::compared},
    PackageKey{"logfreq", KeyUse::program},
    PackageKey{"pH", KeyUse::compared},
    PackageKey{"platform", KeyUse::program},
    PackageKey{"pressure", KeyUse::barostat},
    PackageKey{"pressure_coupling", KeyUse::taken},
    PackageKey{"random_number_seed", KeyUse::taken},
    PackageKey{"ref_bead", KeyUse::start},
    PackageKey{"report_potential_energy", KeyUse::program},
    PackageKey{"restart", KeyUse::taken},
    PackageKey{"runtime", KeyUse::taken},
    PackageKey{"slab_eq", KeyUse::compared},
    PackageKey{"slab_eq_axis", KeyUse::compared},
    PackageKey{"slab_outer", KeyUse::start},
    PackageKey{"slab_width", KeyUse::start},
    PackageKey{"steps", KeyUse::taken},
    PackageKey{"steps_eq", KeyUse::taken},
    PackageKey{"sysname", KeyUse::compared},
    PackageKey{"temp", KeyUse::compared},
    PackageKey{"threads", KeyUse::program},
    PackageKey{"topol", KeyUse::start},
    PackageKey{"verbose", KeyUse::program},
    PackageKey{"wfreq", KeyUse::taken},
};

constexpr std::array of_components = {
    PackageKey{"alpha", KeyUse::origin, "lipid"},
    PackageKey{"bfac_shift", KeyUse::origin, "go"},
    PackageKey{"bfac_width", KeyUse::origin, "go"},
    PackageKey{"charge_termini", KeyUse::compared},
    PackageKey{"colabfold", KeyUse::origin, "go"},
    PackageKey{"cutoff_restr", KeyUse::compared},
    PackageKey{"ext_restraint", KeyUse::compared},
    PackageKey{"fdomains", KeyUse::origin, "restraint"},
    PackageKey{"ffasta", KeyUse::compared},
    PackageKey{"fresidues", KeyUse::compared},
    PackageKey{"k_go", KeyUse::compared},
    PackageKey{"k_harmonic", KeyUse::compared},
    PackageKey{"kb", KeyUse::compared},
    PackageKey{"molecule_type", KeyUse::compared},
    PackageKey{"n_ends", KeyUse::origin, "seastar"},
    PackageKey{"nmol", KeyUse::compared},
    PackageKey{"pae_shift", KeyUse::origin, "go"},
    PackageKey{"pae_width", KeyUse::origin, "go"},
    PackageKey{"pdb_folder", KeyUse::origin, "restraint"},
    PackageKey{"periodic", KeyUse::origin, "restraint"},
    PackageKey{"ptm_locations", KeyUse::origin, "ptm_protein"},
    PackageKey{"ptm_name", KeyUse::origin, "ptm_protein"},
    PackageKey{"restraint", KeyUse::compared},
    PackageKey{"restraint_type", KeyUse::compared},
    PackageKey{"rna_ka", KeyUse::compared, "rna"},
    PackageKey{"rna_kb1", KeyUse::compared, "rna"},
    PackageKey{"rna_kb2", KeyUse::compared, "rna"},
    PackageKey{"rna_nb_cutoff", KeyUse::compared, "rna"},
    PackageKey{"rna_nb_scale", KeyUse::compared, "rna"},
    PackageKey{"rna_nb_sigma", KeyUse::compared, "rna"},
    PackageKey{"rna_pa", KeyUse::compared, "rna"},
    PackageKey{"use_com", KeyUse::origin, "restraint"},
};

/// Keys of names and expressions, which may look like numbers: a structure 1e10.
constexpr std::array<std::string_view, 16> of_texts = {"charge_termini", "custom_restraint_type",
                                                       "ext_force_expr", "fcustom_restraints",
                                                       "fdomains",       "ffasta",
                                                       "fresidues",      "frestart",
                                                       "molecule_type",  "pdb_folder",
                                                       "platform",       "ptm_name",
                                                       "restart",        "restraint_type",
                                                       "sysname",        "topol"};

PackageKey const* key_of(std::span<PackageKey const> keys, std::string_view name) {
    auto const found = std::find_if(keys.begin(), keys.end(),
                                    [&](PackageKey const& key) { return key.name == name; });
    return found == keys.end() ? nullptr : &*found;
}

/// Notes the entries of a map that the package does not read, each name once.
void note_unknown(Node const& map, std::span<PackageKey const> keys, char const* file,
                  std::set<std::string>& said, std::vector<std::string>& notes) {
    std::vector<std::string_view> names;
    for (PackageKey const& key : keys) names.push_back(key.name);
    for (Node const& item : map.items) {
        if (key_of(keys, item.key) != nullptr || !said.insert(item.key).second) continue;
        auto const meant = scene::nearest(item.key, names);
        notes.push_back(fmt::format(
            "{} has `{}`, which is not among the package's keys: it is not taken over{}.", file,
            scene::shown(item.key),
            meant ? fmt::format(" (is `{}` meant?)", *meant) : std::string()));
    }
}

/// Notes numbers that the package takes for texts.
void note_texts(Node const& map, std::span<PackageKey const> keys, char const* file,
                std::vector<std::string>& notes) {
    for (Node const& item : map.items) {
        bool const is_text =
            std::find(of_texts.begin(), of_texts.end(), item.key) != of_texts.end();
        if (is_text || key_of(keys, item.key) == nullptr || !is_text_of_package(item)) continue;
        notes.push_back(
            fmt::format("{} has {} `{}`, which PyYAML takes for a text, so that the package stops; "
                        "here it is a number (write 1.0e+8 for 1e8).",
                        file, item.key, scene::shown(item.text)));
    }
}

/// Returns the keys of that use which the configuration has.
std::vector<std::string> used(PackageFile const& config, KeyUse use) {
    std::vector<std::string> names;
    for (PackageKey const& key : of_config)
        if (key.use == use && config.find(key.name) != nullptr) names.emplace_back(key.name);
    return names;
}

void note_configuration(PackageFile const& config, std::vector<std::string>& notes) {
    struct Reason {
        KeyUse use;
        char const* why;
    };
    std::vector<std::string> parts;
    for (Reason const& reason :
         {Reason{KeyUse::program, "how the package runs"},
          {KeyUse::start, "where molecules start, which the topology says"},
          {KeyUse::barostat, "the package's barostat, where the scene has a constant volume"}})
        if (auto const names = used(config, reason.use); !names.empty())
            parts.push_back(fmt::format("{} ({})", fmt::join(names, ", "), reason.why));
    if (!parts.empty())
        notes.push_back(
            fmt::format("Not taken over from config.yaml: {}.", fmt::join(parts, "; ")));
}

/// True if a component is of the kind for which the key counts.
bool counts(PackageKey const& key, Node const& component, Node const* defaults) {
    auto const property = [&](char const* name) {
        Node const* const own = component.find(name);
        return valued(own != nullptr || defaults == nullptr ? own : defaults->find(name));
    };
    auto const is = [&](char const* name, std::string_view word) {
        Node const* const found = property(name);
        return found != nullptr && found->text.ends_with(word);
    };
    Node const* const restraint = property("restraint");
    bool const restrained = restraint != nullptr && truth_of(*restraint);
    if (key.only_for == "restraint") return restrained;
    if (key.only_for == "go") return restrained && is("restraint_type", "go");
    return is("molecule_type", key.only_for);
}

void note_components(PackageFile const& file, std::string const& system,
                     std::vector<std::string>& notes) {
    Node const *const defaults = file.find("defaults"), *const components = file.find("system");
    std::set<std::string> said, origins;
    if (defaults != nullptr) {
        note_unknown(*defaults, of_components, "components.yaml", said, notes);
        note_texts(*defaults, of_components, "components.yaml", notes);
    }
    if (components == nullptr) return;
    for (Node const& component : components->items) {
        note_unknown(component, of_components, "components.yaml", said, notes);
        note_texts(component, of_components, "components.yaml", notes);
        for (PackageKey const& key : of_components) {
            bool const has = component.find(key.name) != nullptr ||
                             (defaults != nullptr && defaults->find(key.name) != nullptr);
            if (key.use == KeyUse::origin && has && counts(key, component, defaults))
                origins.emplace(key.name);
        }
    }
    if (!origins.empty())
        notes.push_back(
            fmt::format("Not compared from components.yaml: {}. {} has what the "
                        "package made of them.",
                        fmt::join(origins, ", "), system));
}

}  // namespace

std::span<PackageKey const> config_keys() { return of_config; }
std::span<PackageKey const> component_keys() { return of_components; }

void note_keys(PackageFile const& config, PackageFile const* components, std::string const& system,
               std::vector<std::string>& notes) {
    std::set<std::string> said;
    note_unknown(config.root(), of_config, "config.yaml", said, notes);
    note_texts(config.root(), of_config, "config.yaml", notes);
    note_configuration(config, notes);
    if (components != nullptr) note_components(*components, system, notes);
}

}  // namespace catena::foreign
