// Implements families: the mapping from chains to families and their random sample chains.
#include "plan/family.hpp"

#include <algorithm>
#include <map>

#include "generate/generators.hpp"
#include "joints/joint_models.hpp"
#include "scene/branch_limits.hpp"
#include "scene/freedom.hpp"
#include "tree/load_balance.hpp"

namespace catena::plan {
namespace {

using scene::HandleKind;
using scene::RandomJoint;

/// Names of the random joints, as in --joints.
constexpr std::pair<RandomJoint, char const*> joint_names[] = {
    {RandomJoint::link, "link"},           {RandomJoint::planar, "planar"},
    {RandomJoint::spherical, "spherical"}, {RandomJoint::universal, "universal"},
    {RandomJoint::revolute, "revolute"},   {RandomJoint::prismatic, "prismatic"},
    {RandomJoint::weld, "weld"},           {RandomJoint::mixed, "mixed"}};

/// True if the type of a joint of the chain, its jointed tip included, has the property.
bool any_joint(ChainSpec const& chain, bool (*has)(JointType)) {
    return std::any_of(chain.bodies.joint.begin(), chain.bodies.joint.end(), has) ||
           (chain.tip == Tip::jointed && has(chain.tip_joint.type));
}

/// Returns the random joint that represents a chain of rigid bodies in measurements.
RandomJoint joint_of(ChainSpec const& chain) {
    bool const sliding = any_joint(chain, slides);
    switch (scene::handle_kind(chain)) {
        case HandleKind::planar:
            return RandomJoint::planar;
        case HandleKind::spherical:
            return RandomJoint::spherical;
        case HandleKind::universal:
            return RandomJoint::universal;
        case HandleKind::revolute:
            return sliding ? RandomJoint::prismatic : RandomJoint::revolute;
        default:
            return sliding || any_joint(chain, turns_twice) ? RandomJoint::mixed
                                                            : RandomJoint::weld;
    }
}

/// Returns the family of a chain.
Family family_of(ChainSpec const& chain, Axes axes, Handles handles) {
    if (chain.is_beads()) return {RandomJoint::link, false, Axes::world, handles};
    if (chain.is_linked()) return {RandomJoint::link, true, Axes::world, handles};
    return {axes == Axes::world ? RandomJoint::spherical : joint_of(chain), false, axes, handles};
}

/// Returns the number of merges on each level of the pairwise trees of chains with these lengths.
std::vector<std::int64_t> merges_of(std::vector<std::int64_t> const& lengths) {
    std::vector<std::int64_t> merges;
    for (std::int64_t const bodies : lengths) {
        dca::ChainTree const tree(bodies, dca::run_length_for(true));
        merges.resize(std::max(merges.size(), static_cast<std::size_t>(tree.levels())), 0);
        for (int level = 0; level < tree.levels(); ++level)
            merges[static_cast<std::size_t>(level)] += tree.nodes(level) - tree.nodes(level + 1);
    }
    return merges;
}

}  // namespace

std::string Family::name() const {
    auto const found = std::find_if(std::begin(joint_names), std::end(joint_names),
                                    [&](auto const& each) { return each.first == joint; });
    std::string text = found->second;
    if (linked) text += " with bodies";
    if (axes == Axes::world && joint != RandomJoint::link) text += ", ground axes";
    if (handles == Handles::full) text += ", full handles";
    if (handles == Handles::articulated) text += ", articulated handles";
    return text;
}

std::vector<Family> all_families() {
    std::vector<Family> all;
    for (Handles const handles : {Handles::projected, Handles::full}) {
        all.push_back({RandomJoint::link, false, Axes::world, handles});
        all.push_back({RandomJoint::link, true, Axes::world, handles});
        all.push_back({RandomJoint::spherical, false, Axes::world, handles});
        for (auto const& [joint, name] : joint_names)
            if (joint != RandomJoint::link) all.push_back({joint, false, Axes::joint, handles});
    }
    return all;
}

std::vector<Share> shares_of(Scene const& scene, Axes axes, int ranks) {
    struct Members {
        Family family;
        HandleKind largest = HandleKind::link;
        /// True if one rank computes a whole chain.
        bool whole = false;
        std::vector<std::int64_t> lengths;
    };
    std::map<std::string, Members> groups;
    for (ChainSpec const& chain : scene.chains) {
        Family const family = family_of(chain, axes, scene.solver.handles);
        // Full handles put chains of all joints into one group; the most demanding chain represents
        // it.
        bool const together =
            carries_all(scene.solver.handles) && family.joint != RandomJoint::link;
        bool const whole = scene::goes_by_paths(chain);
        Members& members =
            groups[together ? "bodies" : family.name() + (whole ? ", whole chains" : "")];
        members.whole = whole;
        HandleKind const kind = scene::handle_kind(chain);
        if (members.lengths.empty() || kind > members.largest) members.family = family;
        members.largest = std::max(members.largest, kind);
        members.lengths.push_back(static_cast<std::int64_t>(chain.size()));
    }
    std::vector<Share> shares;
    for (auto const& [name, members] : groups) {
        dca::Partition partition(members.lengths, scene.solver.pairwise(), ranks);
        partition.whole_chains = members.whole;
        if (members.whole) dca::cut_by_shares(partition, ranks, {});
        Share share{members.family, 0, merges_of(members.lengths)};
        for (std::size_t r = 0; r + 1 < partition.first_of_rank.size(); ++r)
            share.bodies =
                std::max(share.bodies, partition.first_of_rank[r + 1] - partition.first_of_rank[r]);
        for (std::int64_t& merges : share.merges)
            merges = (merges * share.bodies + partition.bodies() - 1) / partition.bodies();
        shares.push_back(share);
    }
    return shares;
}

Scene sample(Family const& family, std::int64_t bodies) {
    scene::RandomChain random;
    random.bodies = bodies;
    random.joint = family.joint;
    random.base = family.joint == RandomJoint::link ? Base::free : Base::fixed;
    random.seed = 1;
    if (family.linked) random.rigid = 0.5;
    Scene made;
    made.title = family.name();
    made.file = "sample";
    made.forces.gravity = {{0, 0, -9.81}};
    made.solver.handles = family.handles;
    ChainSpec& chain = made.chains.emplace_back();
    chain.name = "sample";
    chain.base = random.base;
    if (family.linked)
        chain.linked = scene::random_linked(random);
    else if (family.joint == RandomJoint::link)
        chain.beads = scene::random_beads(random);
    else
        chain.bodies = scene::random_bodies(random);
    return made;
}

}  // namespace catena::plan
