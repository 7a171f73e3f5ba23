// Implements what OpenMM's forces add to values that decide the motion, and to fingerprints.
#include "terms/openmm_term.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "scene/force_changes.hpp"
#include "terms/deciding_value.hpp"
#include "terms/fingerprint.hpp"

namespace catena::terms {
namespace {

constexpr std::size_t longest_list = 200;  // characters

}  // namespace

void OpenMmTerm::decide(Scene const& scene, scene::DecidingValues& values) {
    using scene::content_print, scene::text_print;
    if (!scene.forces.openmm) return;
    OpenMmSpec const& o = *scene.forces.openmm;
    std::string const at = "forces.openmm.";
    auto const content = [&](char const* key, std::string const& path) {
        if (!path.empty()) add(values, at + key, "content " + content_print(path));
    };
    if (!o.builder.empty()) add(values, at + "builder", o.builder);
    content("system", o.system);
    content(o.builder.empty() ? "topology" : "residues", o.topology);
    std::vector<std::string> map;
    for (auto const& [chain, range] : chain_map(o))
        map.push_back(fmt::format("{}: [{}, {}]", chain, range.first, range.second));
    std::string list = fmt::format("{}", fmt::join(map, ", "));
    if (list.size() > longest_list)
        list = fmt::format("{} entries {}", map.size(),
                           text_print(list));  // one line names the difference
    if (!map.empty()) add(values, at + (o.builder.empty() ? "map" : "charge_termini"), list);
    add(values, at + "temperature", o.temperature);
    add(values, at + "ionic_strength", o.ionic_strength);
    if (o.ph) add(values, at + "ph", *o.ph);
    add(values, at + "switch_width", o.switch_width);
    if (!o.force_groups.empty())
        add(values, at + "force_groups", fmt::format("{}", fmt::join(o.force_groups, ", ")));
    ForceChanges const changes = changes_of(o);
    if (!changes.leave_out.empty())
        add(values, at + "leave_out", fmt::format("{}", fmt::join(changes.leave_out, ", ")));
    for (auto const& [force, length] : changes.links)
        add(values, fmt::format("{}links.{}", at, force), length);
    for (std::size_t i = 0; i < changes.extra.size(); ++i)
        add(values, fmt::format("{}extra[{}]", at, i),
            "content " + content_print(changes.extra[i]));
}

void OpenMmTerm::print(Scene const& scene, scene::Fingerprint& print) {
    using scene::content_of;
    print.add(scene.forces.openmm.has_value());
    if (!scene.forces.openmm) return;
    OpenMmSpec const& o = *scene.forces.openmm;
    print.add_each(o.builder, content_of(o.system), content_of(o.topology), chain_map(o),
                   o.temperature, o.ionic_strength, o.ph, o.switch_width);
    print.add(o.force_groups);
    ForceChanges const changes = changes_of(o);
    add_named(print, "left out", !changes.leave_out.empty(), changes.leave_out);
    for (auto const& [force, length] : changes.links)
        add_named(print, "links", true, force, length);
    for (std::string const& file : changes.extra) add_named(print, "extra", true, content_of(file));
}

std::string OpenMmTerm::text(Scene const& scene) {
    if (!scene.forces.openmm) return {};
    OpenMmSpec const& openmm = *scene.forces.openmm;
    if (openmm.builder.empty())
        return "OpenMM System " + std::filesystem::path(openmm.system).filename().string();
    return fmt::format("{} at {} K and {} mol/l", openmm.builder, openmm.temperature,
                       openmm.ionic_strength);
}

}  // namespace catena::terms
