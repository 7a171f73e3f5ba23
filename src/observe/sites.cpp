// Implements the sites of a scene's bodies.
#include "observe/sites.hpp"

#include <algorithm>

#include "scene/branches.hpp"

namespace catena {

Sites::Sites(Scene const& scene) : Sites(scene, {{0, scene.bodies()}}, true) {}
Sites::Sites(Scene const& scene, std::vector<SceneWindows::Run> const& own)
    : Sites(scene, own, false) {}

Sites::Sites(Scene const& scene, std::vector<SceneWindows::Run> const& runs, bool with_topology)
    : runs_(runs) {
    topology_.title = scene.title;
    topology_.box = scene.box;
    topology_.si = scene.si;
    topology_.body_states = scene.output.coordinates;
    topology_.joint_states =
        scene.output.coordinates && uses_joint_coordinates(scene.dynamics.integrator);
    std::size_t most = 0;
    for (ChainSpec const& chain : scene.chains) most += std::max(chain.size(), chain.bead_count());
    if (with_topology) {
        sites_.reserve(most);
        topology_.mass.reserve(most);
        topology_.residue.reserve(most);
    }
    for (ChainSpec const& chain : scene.chains) {
        // A topology lists all sites; a rank's own sites alone need only their numbers.
        std::size_t const first = next_site_;
        add(chain, with_topology);
        if (!with_topology) continue;
        std::size_t const count = next_site_ - first;
        bool const all_beads =
            chain.is_beads() || (chain.bead_count() > 0 && chain.bead_count() == count);
        if (chain.tip == Tip::jointed) topology_.tips.push_back(std::ssize(topology_.chains));
        add_members(chain.members, static_cast<std::int64_t>(first));
        topology_.chains.push_back(
            {chain.name, static_cast<std::int64_t>(first), static_cast<std::int64_t>(count),
             all_beads, chain.is_ring(),
             static_cast<std::int64_t>(topology_.chains.size() / scene.chains_a_replica()),
             chain.parent, scene::ends_of_crosslinks(chain)});
    }
}

/// Adds the members of a chain whose first site is `first`.
void Sites::add_members(Members const& members, std::int64_t first) {
    Members& all = topology_.members;
    for (ResidueRun run : members.runs) {
        run.first += first;
        run.member += all.identifiers.size();
        all.runs.push_back(run);
    }
    all.identifiers.insert(all.identifiers.end(), members.identifiers.begin(),
                           members.identifiers.end());
}

/// True if the next body is one of those in `runs_`.
bool Sites::shows_next() {
    auto const body = static_cast<std::int64_t>(next_body_);
    while (run_ < runs_.size() && runs_[run_].first + runs_[run_].count <= body) ++run_;
    return run_ < runs_.size() && runs_[run_].first <= body;
}

void Sites::add(ChainSpec const& chain, bool with_topology) {
    CarriedBeads const& carried = chain.carried();
    for (std::size_t k = 0; k < chain.size(); ++k, ++next_body_) {
        bool const shown = shows_next();
        auto const add_site = [&](Vec3 const& place, bool is_first, double mass,
                                  std::string const& residue) {
            if (shown) sites_.push_back({next_body_, next_site_, place, is_first});
            ++next_site_;
            if (!with_topology) return;
            topology_.mass.push_back(mass);
            topology_.residue.push_back(residue);
        };
        if (chain.is_beads()) {
            add_site(Vec3::zero(), true, chain.beads.mass[k], chain.beads.residue[k]);
            continue;
        }
        bool const is_bead = chain.is_linked() && chain.linked.is_bead(k);
        if (!is_bead) {
            if (shown) turning_.push_back({next_body_, next_turning_});
            ++next_turning_;
            if (with_topology) topology_.bodies.push_back(static_cast<std::int64_t>(next_site_));
        }
        std::int64_t const begin = carried.offset.empty() ? 0 : carried.offset[k],
                           end = carried.offset.empty() ? 0 : carried.offset[k + 1];
        if (begin == end)
            add_site(Vec3::zero(), true,
                     chain.is_linked() ? chain.linked.mass[k] : chain.bodies.mass[k],
                     is_bead ? "UNK" : "BDY");
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            Vec3 const place =
                chain.is_linked() ? carried.position[i] : carried.position[i] - chain.bodies.com[k];
            add_site(place, i == static_cast<std::size_t>(begin), carried.mass[i],
                     carried.residue[i]);
        }
    }
}

Frame Sites::part(SceneBodies const& bodies, bool velocities, Executor const& executor) const {
    auto const first = static_cast<std::size_t>(bodies.first),
               end = first + bodies.motion.position.size();
    auto const of_body = [&](std::size_t body) {
        return std::lower_bound(sites_.begin(), sites_.end(), body,
                                [](Site const& site, std::size_t b) { return site.body < b; });
    };
    auto const begin = of_body(first);
    auto const turning =
        std::lower_bound(turning_.begin(), turning_.end(), first,
                         [](Turning const& one, std::size_t b) { return one.body < b; });
    Frame part;
    part.first_site = begin != sites_.end() ? begin->site : next_site_;
    part.first_body = turning != turning_.end() ? turning->number : next_turning_;
    SceneMotion const& s = bodies.motion;
    auto const count = static_cast<std::size_t>(of_body(end) - begin);
    part.positions.resize(count);
    if (velocities) part.velocities.resize(count);
    if (!bodies.joint_force.empty()) part.joint_forces.resize(count, Vector<double, 6>::zero());
    executor.for_each(static_cast<std::int64_t>(count), [&](std::int64_t number) {
        Site const& site = begin[number];
        auto const i = static_cast<std::size_t>(number);
        std::size_t const k = site.body - first;
        Mat3 const rotation = to_matrix(s.orientation[k]);
        part.positions[i] = s.position[k] + rotation * site.place;
        if (velocities)
            part.velocities[i] = s.velocity[k] + rotation * cross(s.omega[k], site.place);
        if (!bodies.joint_force.empty() && site.is_first)
            part.joint_forces[i] = bodies.joint_force[k];
    });
    for (auto one = turning; one != turning_.end() && one->body < end; ++one)
        add_state(bodies, one->body - first, part);
    return part;
}

/// `k`: index of the body among `bodies`.
void Sites::add_state(SceneBodies const& bodies, std::size_t k, Frame& part) const {
    SceneMotion const& s = bodies.motion;
    part.orientations.push_back(s.orientation[k]);
    if (topology_.body_states) {
        part.body_positions.push_back(s.position[k]);
        part.body_velocities.push_back(s.velocity[k]);
        part.angular_velocities.push_back(s.omega[k]);
    }
    if (!topology_.joint_states) return;
    part.joint_positions.push_back(bodies.joint_position[k]);
    part.joint_rates.push_back(bodies.joint_rate[k]);
}

}  // namespace catena
