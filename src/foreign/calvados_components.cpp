// Implements the reading of components. The package (version 0.8, calvados/components.py) takes
// properties that a component lacks from `defaults`.
#include "foreign/calvados_components.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error.hpp"
#include "scene/fields.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

/// Reads one component.
CalvadosComponent component_of(Node const& node, Node const* defaults, std::string const& file) {
    if (node.kind != Node::Kind::map)
        throw InputError(fmt::format("component `{}` has no properties", scene::shown(node.key)),
                         file, write_again_or_move);
    CalvadosComponent made;
    // A property that is null overrides the defaults, too.
    auto const property = [&](char const* key) -> Node const* {
        Node const* const own = node.find(key);
        Node const* const found = own != nullptr || defaults == nullptr ? own : defaults->find(key);
        if (found != nullptr) made.places[key] = scene::shown_path(found->where());
        return found;
    };
    auto const word = [&](char const* key, char const* otherwise) {
        Node const* const found = property(key);
        if (found == nullptr) return std::string(otherwise);
        bool const written = valued(found) != nullptr && !found->text.empty();
        return written ? scene::text(*found) : std::string();
    };
    auto const number = [&](char const* key, double& value) {
        Node const* const found = property(key);
        if (found == nullptr) return;
        if (valued(found) == nullptr)
            scene::fail(*found, fmt::format("`{}` has no value, with which the package stops", key),
                        "give a number, or leave the key out");
        value = number_of(*found);
    };
    auto const truth = [&](char const* key, bool& value) {
        if (Node const* const found = property(key))
            value = valued(found) != nullptr && truth_of(*found);
    };
    made.name = node.key;
    made.type = word("molecule_type", "protein");
    if (double copies = 1; property("nmol") != nullptr) {
        number("nmol", copies);
        made.molecules = whole_of(*property("nmol"), 0);
    }
    made.termini = word("charge_termini", "both");
    truth("ext_restraint", made.pulled);
    truth("restraint", made.restrained), truth("periodic", made.periodic);
    made.network = word("restraint_type", "harmonic");
    number("kb", made.kb), number("k_harmonic", made.k_harmonic);
    number("k_go", made.k_go), number("cutoff_restr", made.cutoff_restr);
    number("rna_kb1", made.rna.kb1), number("rna_kb2", made.rna.kb2);
    number("rna_pa", made.rna.pa), number("rna_ka", made.rna.ka);
    number("rna_nb_sigma", made.rna.nb_sigma), number("rna_nb_scale", made.rna.nb_scale);
    number("rna_nb_cutoff", made.rna.nb_cutoff);
    made.residues = word("fresidues", ""), made.sequences = word("ffasta", "");
    return made;
}

}  // namespace

std::int64_t CalvadosComponents::molecules() const {
    std::int64_t sum = 0;
    for (CalvadosComponent const& component : all) sum += component.molecules;
    return sum;
}

bool CalvadosComponents::restrained() const {
    return std::any_of(all.begin(), all.end(),
                       [](CalvadosComponent const& c) { return c.restrained; });
}

bool CalvadosComponents::comparable() const {
    return std::all_of(all.begin(), all.end(), [](CalvadosComponent const& c) {
        return c.is_protein() || c.is_rna() || c.type == "crowder";
    });
}

std::vector<CalvadosComponent const*> CalvadosComponents::of_chains(std::size_t chains) const {
    if (all.size() == 1) return {chains, &all.front()};
    std::vector<CalvadosComponent const*> owners;
    if (molecules() != static_cast<std::int64_t>(chains)) return owners;
    for (CalvadosComponent const& component : all)
        owners.insert(owners.end(), static_cast<std::size_t>(component.molecules), &component);
    return owners;
}

std::string CalvadosComponents::place(CalvadosComponent const& component,
                                      std::string const& property) const {
    auto const found = component.places.find(property);
    return found == component.places.end() ? file : found->second;
}

CalvadosComponents read_components(PackageFile const& file) {
    Node const* const system = file.find("system");
    CalvadosComponents made{scene::shown_path(file.root().text), {}};
    if (system == nullptr || system->kind != Node::Kind::map || system->items.empty())
        throw InputError("the file has no components under `system`", made.file,
                         write_again_or_move);
    Node const* const defaults = file.find("defaults");
    for (Node const& component : system->items)
        made.all.push_back(component_of(component, defaults, made.file));
    std::stable_partition(made.all.begin(), made.all.end(),
                          [](CalvadosComponent const& c) { return c.is_protein(); });
    return made;
}

}  // namespace catena::foreign
