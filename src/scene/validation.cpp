#include "scene/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "force/calvados2.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

namespace {

bool has_joint(ChainSpec const& chain, JointType type) {
    return std::find(chain.bodies.joint.begin(), chain.bodies.joint.end(), type) != chain.bodies.joint.end();
}

void check_names(std::vector<Draft> const& drafts) {
    std::set<std::string> names;
    for (Draft const& draft : drafts)
        if (!names.insert(draft.chain.name).second)
            fail(*draft.node, fmt::format("two chains are named `{}`", shown(draft.chain.name)), "give each its own `name`");
}

/// Dampers act through the joints' rates, which these integrators do not carry.
void refuse_damping(Draft const& draft, Integrator integrator) {
    auto const& damping = draft.chain.bodies.damping;
    auto const found = std::find_if(damping.begin(), damping.end(), [](Vec3 const& d) { return d[0] != 0 || d[1] != 0 || d[2] != 0; });
    if (found == damping.end()) return;
    fail_at(*draft.node, "body", found - damping.begin() + 1, fmt::format("joint damping under integrator {}", name_of(integrator)),
            "use `integrator: rk4`, or set `damping: 0` (g-baoab has `friction`)");
}

void check_integrator(Node const& root, DynamicsSpec const& dynamics, Draft const& draft) {
    ChainSpec const& chain = draft.chain;
    Node const& section = *root.find("dynamics");
    Node const& at = *section.find("integrator");
    if (uses_joint_coordinates(dynamics.integrator)) {
        if (chain.is_beads())
            fail(at, fmt::format("integrator rk4 works in joint coordinates, chain `{}` has links", shown(chain.name)),
                 "use `integrator: rattle` or `g-baoab`");
        return;
    }
    if (has_joint(chain, JointType::revolute))
        fail(at,
             fmt::format("integrator {} moves chains of links or spherical joints, chain `{}` has revolute joints",
                         name_of(dynamics.integrator), shown(chain.name)),
             "use `integrator: rk4`");
    refuse_damping(draft, dynamics.integrator);
}

void check_thermal(Node const& root, DynamicsSpec const& dynamics, Draft const& draft) {
    if (draft.chain.velocities != StartVelocities::thermal) return;
    Node const* const asked = draft.node->find("velocities");
    Node const& at = asked ? *asked : *draft.node;
    Node const* const section = root.find("dynamics");
    bool const named = section && (section->find("temperature") || dynamics.integrator == Integrator::g_baoab);
    if (!named || !(dynamics.temperature > 0))
        fail(at, "thermal velocities without a temperature above 0", "add `dynamics: {temperature: 300}`, or write `velocities: zero`");
    if (has_joint(draft.chain, JointType::revolute))
        fail(at, "thermal velocities for revolute joints", "write `velocities: zero`, or give each joint its `qd`");
}

void check_map(Node const& at, OpenMmSpec const& openmm, std::vector<Draft> const& drafts) {
    for (auto const& [name, range] : openmm.map) {
        auto const found =
            std::find_if(drafts.begin(), drafts.end(), [&, &chain_name = name](Draft const& d) { return d.chain.name == chain_name; });
        Node const& entry = *at.find("map")->find(name);
        if (found == drafts.end()) fail(entry, fmt::format("no chain is named `{}`", shown(name)), "use the chains' names");
        auto const size = static_cast<std::int64_t>(found->chain.size()), given = range.second - range.first + 1;
        if (given != size)
            fail(entry, fmt::format("{} particles for the {} bodies of chain `{}`", given, size, shown(name)),
                 "give [first, last], both included");
    }
}

void check_openmm(Node const& root, OpenMmSpec const& openmm, std::vector<Draft> const& drafts) {
    Node const& at = *root.find("forces")->find("openmm");
    if (std::none_of(drafts.begin(), drafts.end(), [](Draft const& d) { return d.chain.is_beads(); }))
        fail(at, "OpenMM's forces act on beads, no chain of the scene has any", "add a chain of beads or leave `openmm` out");
    check_map(at, openmm, drafts);
    if (openmm.builder != "calvados2") return;
    for (Draft const& draft : drafts)
        for (std::size_t k = 0; k < draft.chain.beads.residue.size(); ++k)
            if (!find_calvados2(draft.chain.beads.residue[k]))
                fail_at(*draft.node, "bead", static_cast<std::int64_t>(k) + 1,
                        fmt::format("residue `{}` has no parameters in calvados2", shown(draft.chain.beads.residue[k])),
                        "give the chain as `sequence`, or its beads a `residue` among the twenty amino acids");
}

}  // namespace

void check_together(Node const& root, Scene const& scene, std::vector<Draft> const& drafts) {
    check_names(drafts);
    Draft const* previous = nullptr;
    for (Draft const& draft : drafts) {
        // Copies of one entry are alike.
        if (previous && previous->node == draft.node) continue;
        previous = &draft;
        if (scene.dynamics.given) check_integrator(root, scene.dynamics, draft);
        check_thermal(root, scene.dynamics, draft);
    }
    if (scene.forces.openmm) check_openmm(root, *scene.forces.openmm, drafts);
}

}  // namespace catena::scene
