// Implements the list of deciding values and its comparison.
#include "terms/deciding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

#include "terms/force_terms.hpp"
#include "terms/hash.hpp"

namespace catena::scene {
namespace {

constexpr std::size_t most_single_chains = 1000;

constexpr char const* key_of_replicas = "replicas";

/// Text of the value of a key that a scene lacks.
std::string absent(std::string const& key) { return key == key_of_replicas ? "1" : "none"; }

using Values = DecidingValues;

/// Adds the terms' values for all bodies that stand in this section.
void add_terms(Values& values, Scene const& scene, terms::Section section) {
    terms::for_each([&](auto term) {
        if (decltype(term)::section == section) decltype(term)::decide(scene, values);
    });
}

void add_dynamics(Values& values, DynamicsSpec const& d) {
    if (!d.given) return;
    add(values, "dynamics.integrator", name_of(d.integrator));
    add(values, "dynamics.step", d.step);
    add(values, "dynamics.temperature", d.temperature);
    add(values, "dynamics.friction", d.friction);
    add(values, "dynamics.seed", d.seed);
    add(values, "dynamics.constraint_tolerance", d.constraint_tolerance);
    if (d.tolerance > 0) add(values, "dynamics.tolerance", d.tolerance);
}

/// Adds the fingerprints of chains. `keeps_start` is true if a joint's frame is fixed at its start
/// placement, which makes start positions fixed.
void add_prints(Values& values, std::string const& whose, ChainPrints const& prints,
                bool keeps_start) {
    add(values, whose + ", bodies and joints", prints.kind, Role::fixed);
    add(values, whose + ", springs and loads", prints.loads);
    add(values, whose + ", start positions", prints.positions,
        keeps_start ? Role::fixed : Role::start);
    add(values, whose + ", start velocities", prints.velocities, Role::start);
}

/// True if the start places a frame of a joint that attaches the tip to the ground or closes a
/// loop.
bool holds_start(ChainSpec const& chain) {
    return (chain.tip == Tip::jointed && !chain.is_ring()) || chain.has_loops();
}

void add_chains(Values& values, std::span<ChainSpec const> chains) {
    add(values, "chains", chains.size(), Role::fixed);
    std::size_t const single = std::min(chains.size(), most_single_chains);
    for (std::size_t i = 0; i < single; ++i)
        add_prints(values, "chain " + std::to_string(i + 1), prints_of(chains.subspan(i, 1)),
                   holds_start(chains[i]));
    std::span<ChainSpec const> const further = chains.subspan(single);
    if (further.empty()) return;
    add_prints(values, "chains from " + std::to_string(single + 1) + " on", prints_of(further),
               std::any_of(further.begin(), further.end(), holds_start));
}

}  // namespace

std::vector<DecidingValue> deciding_values(Scene const& scene) {
    Values values;
    add_dynamics(values, scene.dynamics);
    if (scene.dynamics.given) add_terms(values, scene, terms::Section::dynamics);
    add_terms(values, scene, terms::Section::forces);
    add(values, "box", scene.box ? terms::vector_text(*scene.box) : "none");
    add(values, "units", scene.si ? "si" : "md", Role::fixed);
    if (scene.replicas > 1) add(values, key_of_replicas, scene.replicas, Role::fixed);
    add_chains(values, scene.chains);
    if (scene.relax) add(values, "relax", true, Role::start);
    return values;
}

std::vector<ChangedValue> changes(std::map<std::string, std::string> const& before,
                                  std::vector<DecidingValue> const& now) {
    std::vector<ChangedValue> changed;
    std::map<std::string, std::string> gone = before;
    for (DecidingValue const& each : now) {
        auto const found = before.find(each.key);
        gone.erase(each.key);
        std::string const old = found == before.end() ? absent(each.key) : found->second;
        if (old != each.value) changed.push_back({each.key, old, each.value, each.role});
    }
    for (auto const& [key, value] : gone) {
        Role const role = key.starts_with("chain") || key == key_of_replicas ? Role::fixed
                          : key == "relax"                                   ? Role::start
                                                                             : Role::free;
        changed.push_back({key, value, absent(key), role});
    }
    // Other replicas are other chains: their number is what the user changed.
    std::stable_partition(changed.begin(), changed.end(),
                          [](ChangedValue const& each) { return each.key == key_of_replicas; });
    return changed;
}

}  // namespace catena::scene
