// Implements the checks that involve more than one section of a scene. Each check names the key
// that must change. Copies of an entry are checked once.
#include "reader/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <unordered_map>

#include "reader/models.hpp"
#include "scene/branch_limits.hpp"
#include "scene/fields.hpp"
#include "scene/force_changes.hpp"
#include "scene/freedom.hpp"
#include "structure/calvados2.hpp"
#include "terms/force_terms.hpp"

namespace catena::scene {

namespace {

/// Throws InputError for two chains of the same name.
void check_names(std::vector<Draft> const& drafts) {
    std::set<std::string> names;
    for (Draft const& draft : drafts)
        if (!names.insert(draft.chain.name).second)
            fail(*draft.node, fmt::format("two chains are named `{}`", shown(draft.chain.name)),
                 "give each its own `name`");
}

/// Advice for forces that only integrators in joint coordinates support.
std::string const joint_integrators =
    "use `integrator: rk4`, `velocity-verlet` or `dormand-prince`";

/// Refuses forces that depend on velocities. Absolute coordinates do not support them, and a
/// thermostat does not compensate them.
void refuse_resistance(Node const& root, Scene const& scene, Draft const& draft) {
    Integrator const integrator = scene.dynamics.integrator;
    std::string const under = fmt::format(" with integrator {}", name_of(integrator));
    std::string const thermostat =
        name_of(is_langevin(integrator) ? integrator : Integrator::g_baoab);
    terms::for_each([&](auto term) {
        using Term = decltype(term);
        if constexpr (Term::depends_on_velocities) {
            if (Term::count(scene, draft.chain) == 0) return;
            std::string const what = Term::in_messages + under,
                              remedy = fmt::format("{}, or {} ({} has `friction`)",
                                                   joint_integrators, Term::remedy, thermostat);
            for (std::size_t k = 0; k < draft.chain.size(); ++k)
                if (Term::acts_on(draft.chain, k))
                    fail_at(*draft.node, "body", static_cast<std::int64_t>(k) + 1, what, remedy);
            if constexpr (Term::scene_key != nullptr)
                fail(*root.find("forces")->find(Term::scene_key), what, remedy);
        }
    });
}

/// Checks that springs and dampers add a well-conditioned inertia along all coordinates of a joint,
/// see ImplicitInertias.
void check_implicit(DynamicsSpec const& dynamics, Draft const& draft) {
    BodyArrays const& bodies = draft.chain.bodies;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        if (!resists(bodies, k)) continue;
        ImplicitInertias const inertias = implicit_inertias(bodies, k, dynamics);
        auto const body = static_cast<std::int64_t>(k) + 1;
        std::string const under = fmt::format(" with integrator {}", name_of(dynamics.integrator));
        if (!inertias.are_definite())
            fail_at(*draft.node, "body", body,
                    "a joint with springs or dampers along only some of its coordinates" + under,
                    "give it some stiffness or damping along each, or none");
        if (!inertias.are_alike())
            fail_at(
                *draft.node, "body", body,
                fmt::format(
                    "a joint that is {:.3g} times as stiff along one coordinate as along another{}",
                    inertias.most / inertias.least, under),
                fmt::format("keep this ratio within {:g}", ImplicitInertias::widest));
    }
}

/// Checks that the integrator supports the chain's joints and forces.
void check_integrator(Node const& root, Scene const& scene, Draft const& draft) {
    ChainSpec const& chain = draft.chain;
    Integrator const integrator = scene.dynamics.integrator;
    Node const& at = *root.find("dynamics")->find("integrator");
    // Forces of implicit springs are known within a step only.
    if (is_implicit(integrator) && scene.output.joint_forces)
        fail(*root.find("output")->find("joint_forces"),
             fmt::format("not in this version: joint forces with integrator {}",
                         name_of(integrator)),
             "leave it out");
    if (uses_joint_coordinates(integrator)) {
        if (chain.is_beads() || chain.is_linked())
            fail(at,
                 fmt::format("integrator {} works in joint coordinates, chain `{}` has links",
                             name_of(integrator), shown(chain.name)),
                 "use `integrator: rattle` or `g-baoab`");
        if (is_implicit(integrator) && is_body_tree(chain))
            fail(at,
                 fmt::format("not in this version: implicit springs and dampers of branched chains "
                             "of rigid bodies, such as chain `{}`",
                             shown(chain.name)),
                 joint_integrators + ", or `baoab`");
        if (is_implicit(integrator)) check_implicit(scene.dynamics, draft);
        if (is_langevin(integrator)) refuse_resistance(root, scene, draft);
        return;
    }
    if (chain.has_loops())
        fail(at,
             fmt::format("integrator {} works in absolute coordinates, chain `{}` has loops",
                         name_of(integrator), shown(chain.name)),
             joint_integrators);
    if (is_body_tree(chain))
        fail(
            at,
            fmt::format("integrator {} moves no branched chains of rigid bodies, chain `{}` is one",
                        name_of(integrator), shown(chain.name)),
            joint_integrators);
    if (auto const odd = joint_without_absolute_coordinates(chain)) {
        std::string const place =
            odd->first < chain.bodies.size() ? fmt::format("joint {}", odd->first + 1) : "its tip";
        fail(at,
             fmt::format("integrator {} moves chains of links or spherical joints, chain `{}` has "
                         "a {} joint ({})",
                         name_of(integrator), shown(chain.name), name_of(odd->second), place),
             joint_integrators);
    }
    refuse_resistance(root, scene, draft);
    if (is_implicit(integrator)) check_implicit(scene.dynamics, draft);
    if (!chain.bodies.driven.empty())
        fail_at(*draft.node, "body", chain.bodies.driven[0].body + 1,
                fmt::format("a prescribed motion with integrator {}", name_of(integrator)),
                joint_integrators + ", or leave it out");
}

/// Checks that articulated handles support the chain. `projected`: some chain of the scene has
/// projected handles only.
void check_handles(Node const& root, Scene const& scene, Draft const& draft, bool projected) {
    if (scene.solver.handles == Handles::full && is_body_tree(draft.chain))
        fail(*root.find("solver")->find("handles"),
             fmt::format("full handles for chain `{}`, a branched chain of rigid bodies",
                         shown(draft.chain.name)),
             "leave it out: such chains have articulated handles");
    if (scene.solver.handles != Handles::articulated || takes_articulated_handles(draft.chain))
        return;
    ChainSpec const& chain = draft.chain;
    char const* const why = chain.bodies.size() == 0 ? "has links"
                            : chain.is_ring()        ? "is a ring"
                                                     : "has a jointed tip";
    fail(*root.find("solver")->find("handles"),
         fmt::format("articulated handles for chain `{}`, which {}", shown(chain.name), why),
         std::string(projected ? "use `projected`" : "use `projected` or `full`") +
             ": articulated ones are for open chains of rigid bodies");
}

/// Sets the handles of a scene of branched chains of rigid bodies, which have articulated handles
/// whatever the other chains have. Throws InputError if all chains are such and others are written.
void set_handles(Node const& root, Scene& scene, std::vector<Draft> const& drafts) {
    if (drafts.empty() || scene.solver.handles != Handles::projected ||
        !std::all_of(drafts.begin(), drafts.end(),
                     [](Draft const& d) { return is_body_tree(d.chain); }))
        return;
    Node const* const section = root.find("solver");
    if (Node const* const written = section ? section->find("handles") : nullptr)
        fail(*written, "projected handles for branched chains of rigid bodies",
             "leave it out: such chains have articulated handles");
    scene.solver.handles = Handles::articulated;
}

/// Checks that the Fixman correction supports the chain.
void check_fixman(Node const& root, DynamicsSpec const& dynamics, Draft const& draft) {
    if (!dynamics.fixman) return;
    Node const& at = *root.find("dynamics")->find("fixman");
    if (!draft.chain.is_beads())
        fail(at,
             fmt::format(
                 "the Fixman correction of chain `{}`, which does not consist of point beads only",
                 shown(draft.chain.name)),
             "leave it out: only links between point beads have it");
    if (draft.chain.is_ring())
        fail(at,
             fmt::format("not in this version: the Fixman correction of the ring `{}`",
                         shown(draft.chain.name)),
             "leave it out");
    if (draft.chain.redundant_links > 0)
        fail(at,
             fmt::format("the Fixman correction of chain `{}`, {} of whose links {} redundant",
                         shown(draft.chain.name), draft.chain.redundant_links,
                         draft.chain.redundant_links == 1 ? "is" : "are"),
             "leave it out, or leave out cross-links until none is redundant");
    if (!(dynamics.temperature > 0))
        fail(at, "the Fixman correction without a temperature above 0", "add `temperature: 300`");
}

/// Refuses forces for all bodies that do not act on links: silence about the others would be
/// misleading.
void check_forces(Node const& root, Scene const& scene, Draft const& draft) {
    if (!draft.chain.is_beads() && !draft.chain.is_linked()) return;
    terms::for_each([&](auto term) {
        using Term = decltype(term);
        if constexpr (Term::scene_key != nullptr && !Term::on_links)
            if (Term::is_everywhere(scene.forces))
                fail(*root.find("forces")->find(Term::scene_key),
                     fmt::format("{} on chain `{}`, which has links", Term::in_messages,
                                 shown(draft.chain.name)),
                     "leave it out: g-baoab has `friction`");
    });
}

/// Checks that thermal velocities can be drawn for the chain.
void check_thermal(Node const& root, DynamicsSpec const& dynamics, Draft const& draft) {
    if (draft.chain.velocities != StartVelocities::thermal) return;
    Node const* const asked = draft.node->find("velocities");
    Node const& at = asked ? *asked : *draft.node;
    Node const* const section = root.find("dynamics");
    if (dynamics.given && is_implicit(dynamics.integrator) &&
        uses_joint_coordinates(dynamics.integrator))
        fail(at,
             fmt::format(
                 "thermal velocities with integrator {}, whose stiff joints rotate more slowly",
                 name_of(dynamics.integrator)),
             is_langevin(dynamics.integrator)
                 ? "write `velocities: zero`: its thermostat warms the chain"
                 : "write `velocities: zero`, or give each joint its `qd`");
    bool const named =
        section && (section->find("temperature") || is_langevin(dynamics.integrator));
    if (!named || !(dynamics.temperature > 0))
        fail(at, "thermal velocities without a temperature above 0",
             std::string(section ? "give `temperature: 300` in `dynamics`"
                                 : "add `dynamics: {temperature: 300}`") +
                 ", or write `velocities: zero`");
    if (draft.chain.has_loops())
        fail(at, "thermal velocities in a chain with loops",
             "write `velocities: zero`, or give each joint its `qd`");
    if (is_body_tree(draft.chain))
        fail(at, "thermal velocities for a branched chain of rigid bodies",
             "write `velocities: zero`, or give each joint its `qd`; `integrator: baoab` warms it");
    if (auto const odd = joint_without_absolute_coordinates(draft.chain))
        fail(at, fmt::format("thermal velocities for {} joints", name_of(odd->second)),
             "write `velocities: zero`, or give each joint its `qd`");
}

/// True if OpenMM has points of the chain to act on.
bool has_beads(ChainSpec const& chain) {
    return chain.is_beads() || chain.bodies.carried.size() > 0 || chain.linked.carried.size() > 0;
}

/// Residue names of the points known to OpenMM.
std::vector<std::string> const& residues_of(ChainSpec const& chain) {
    return chain.is_beads()    ? chain.beads.residue
           : chain.is_linked() ? chain.linked.carried.residue
                               : chain.bodies.carried.residue;
}

/// Checks that each entry of `map` names a chain and has one particle per bead.
void check_map(Node const& at, OpenMmSpec const& openmm, std::vector<Draft> const& drafts) {
    std::unordered_map<std::string_view, Draft const*> of_name;
    for (Draft const& draft : drafts) of_name.emplace(draft.chain.name, &draft);
    ChainMap const map = chain_map(openmm);
    for (std::size_t i = 0; i < map.size(); ++i) {
        auto const& [name, range] = map[i];
        auto const found = of_name.find(name);
        Node const& entry = at.find("map")->items[i];  // entries are in the order of the file
        if (found == of_name.end())
            fail(entry, fmt::format("no chain is named `{}`", shown(name)),
                 "use the chains' names");
        auto const size = static_cast<std::int64_t>(residues_of(found->second->chain).size()),
                   given = range.second - range.first + 1;
        if (given != size)
            fail(entry,
                 fmt::format("{} particles for the {} beads of chain `{}`", given, size,
                             shown(name)),
                 "give [first, last], both included");
    }
}

/// Checks that OpenMM's forces find beads, and the builder parameters for each residue.
void check_openmm(Node const& root, Scene const& scene, std::vector<Draft> const& drafts) {
    OpenMmSpec const& openmm = *scene.forces.openmm;
    Node const& at = *root.find("forces")->find("openmm");
    if (std::none_of(drafts.begin(), drafts.end(),
                     [](Draft const& d) { return has_beads(d.chain); }))
        fail(at, "OpenMM's forces act on beads, no chain of the scene has any",
             "add a chain of beads or leave `openmm` out");
    if (openmm.builder.empty()) check_map(at, openmm, drafts);
    if (openmm.builder.empty()) return;
    ForceResidues const forces(openmm);
    Draft const* previous = nullptr;
    for (Draft const& draft : drafts) {
        // Copies of one entry have the same residues.
        if (!previous || previous->node != draft.node)
            check_residues(*draft.node, residues_of(draft.chain), scene, forces);
        previous = &draft;
    }
}

/// Refuses the observable `temperature` if it has no meaning. The default columns omit it; a
/// request by name must not be ignored.
void check_temperature(Node const& root, OutputSpec const& output, DynamicsSpec const& dynamics,
                       std::vector<Draft> const& drafts) {
    auto const asked =
        std::find(output.observables.begin(), output.observables.end(), "temperature");
    if (asked == output.observables.end()) return;
    Node const& at = root.find("output")
                         ->find("observables")
                         ->items[static_cast<std::size_t>(asked - output.observables.begin())];
    auto const driven = std::find_if(drafts.begin(), drafts.end(),
                                     [](Draft const& d) { return !d.chain.bodies.driven.empty(); });
    if (driven != drafts.end())
        fail(at,
             fmt::format("the temperature is undefined because a joint of chain `{}` is driven",
                         shown(driven->chain.name)),
             "leave it out");
    if (std::all_of(drafts.begin(), drafts.end(),
                    [](Draft const& d) { return degrees_of_freedom(d.chain) <= 0; }))
        fail(at, "the temperature is undefined because nothing can move", "leave it out");
    if (dynamics.given && is_implicit(dynamics.integrator))
        fail(at,
             fmt::format("the temperature is undefined with integrator {}, whose stiff joints "
                         "rotate more slowly",
                         name_of(dynamics.integrator)),
             "leave it out");
}

/// Refuses the end-to-end distance by name where no chain has two ends.
void check_end_to_end(Node const& root, OutputSpec const& output,
                      std::vector<Draft> const& drafts) {
    auto const asked =
        std::find(output.observables.begin(), output.observables.end(), "end_to_end_distance");
    if (asked == output.observables.end()) return;
    if (std::any_of(drafts.begin(), drafts.end(),
                    [](Draft const& d) { return !d.chain.is_branched(); }))
        return;
    fail(root.find("output")
             ->find("observables")
             ->items[static_cast<std::size_t>(asked - output.observables.begin())],
         "branched chains have no end-to-end distance",
         "leave it out; `radius_of_gyration` is their size");
}

/// Notes that trajectories have no forces of cross-links and loops.
void note_forces_left_out(Scene& scene, std::vector<Draft> const& drafts) {
    if (!scene.output.joint_forces) return;
    auto const note = [&](char const* closures, auto const& has) {
        auto const first = std::find_if(drafts.begin(), drafts.end(),
                                        [&](Draft const& d) { return has(d.chain); });
        if (first != drafts.end())
            scene.note(
                fmt::format("`joint_forces` leaves out the forces of {}, of chain `{}` for "
                            "one: `catena solve --json` gives those of a start",
                            closures, shown(first->chain.name)));
    };
    note("cross-links", [](ChainSpec const& chain) { return chain.is_cross_linked(); });
    note("loops", [](ChainSpec const& chain) { return chain.has_loops(); });
}

}  // namespace

void check_together(Node const& root, Scene& scene, std::vector<Draft> const& drafts) {
    check_names(drafts);
    bool const projected = std::any_of(drafts.begin(), drafts.end(), [](Draft const& d) {
        return goes_by_paths(d.chain) && !is_body_tree(d.chain);
    });
    Draft const* previous = nullptr;
    for (Draft const& draft : drafts) {
        // Copies of one entry have the same properties.
        if (previous && previous->node == draft.node) continue;
        previous = &draft;
        check_forces(root, scene, draft);
        check_handles(root, scene, draft, projected);
        if (scene.dynamics.given) check_integrator(root, scene, draft);
        check_fixman(root, scene.dynamics, draft);
        check_thermal(root, scene.dynamics, draft);
    }
    set_handles(root, scene, drafts);
    check_temperature(root, scene.output, scene.dynamics, drafts);
    check_end_to_end(root, scene.output, drafts);
    note_forces_left_out(scene, drafts);
    if (scene.forces.openmm) check_openmm(root, scene, drafts);
}

}  // namespace catena::scene
