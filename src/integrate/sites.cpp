#include "integrate/sites.hpp"

#include <algorithm>

namespace catena {

Sites::Sites(Scene const& scene) {
    topology_.title = scene.title;
    topology_.box = scene.box;
    topology_.si = scene.si;
    std::size_t body = 0;
    for (ChainSpec const& chain : scene.chains) {
        auto const first = static_cast<std::int64_t>(sites_.size());
        add(chain, body);
        bool const all_beads =
            chain.is_beads() || (chain.bead_count() > 0 && chain.bead_count() == sites_.size() - static_cast<std::size_t>(first));
        if (chain.tip == Tip::jointed) topology_.tips.push_back(std::ssize(topology_.chains));
        topology_.chains.push_back({chain.name, first, static_cast<std::int64_t>(sites_.size()) - first, all_beads, chain.is_ring()});
        body += chain.size();
    }
}

void Sites::add(ChainSpec const& chain, std::size_t first_body) {
    CarriedBeads const& carried = chain.carried();
    auto const add_site = [&](std::size_t k, Vec3 const& place, bool is_first, double mass, std::string const& residue) {
        sites_.push_back({first_body + k, place, is_first});
        topology_.mass.push_back(mass);
        topology_.residue.push_back(residue);
    };
    for (std::size_t k = 0; k < chain.size(); ++k) {
        if (chain.is_beads()) {
            add_site(k, Vec3::zero(), true, chain.beads.mass[k], chain.beads.residue[k]);
            continue;
        }
        bool const is_bead = chain.is_linked() && chain.linked.is_bead(k);
        if (!is_bead) {
            turning_.push_back(first_body + k);
            topology_.bodies.push_back(static_cast<std::int64_t>(sites_.size()));
        }
        std::int64_t const begin = carried.offset.empty() ? 0 : carried.offset[k], end = carried.offset.empty() ? 0 : carried.offset[k + 1];
        if (begin == end)
            add_site(k, Vec3::zero(), true, chain.is_linked() ? chain.linked.mass[k] : chain.bodies.mass[k], is_bead ? "UNK" : "BDY");
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            Vec3 const place = chain.is_linked() ? carried.position[i] : carried.position[i] - chain.bodies.com[k];
            add_site(k, place, i == static_cast<std::size_t>(begin), carried.mass[i], carried.residue[i]);
        }
    }
}

Frame Sites::part(ChainSystem::Bodies const& bodies, bool velocities) const {
    auto const first = static_cast<std::size_t>(bodies.first), end = first + bodies.motion.position.size();
    auto const begin = std::lower_bound(sites_.begin(), sites_.end(), first, [](Site const& site, std::size_t b) { return site.body < b; });
    auto const turning = std::lower_bound(turning_.begin(), turning_.end(), first);
    Frame part;
    part.first_site = static_cast<std::size_t>(begin - sites_.begin());
    part.first_body = static_cast<std::size_t>(turning - turning_.begin());
    ChainSystem::Snapshot const& s = bodies.motion;
    for (auto site = begin; site != sites_.end() && site->body < end; ++site) {
        std::size_t const k = site->body - first;
        Mat3 const turn = to_matrix(s.orientation[k]);
        part.positions.push_back(s.position[k] + turn * site->place);
        if (velocities) part.velocities.push_back(s.velocity[k] + turn * cross(s.omega[k], site->place));
        if (!bodies.joint_force.empty()) part.joint_forces.push_back(site->is_first ? bodies.joint_force[k] : Vector<double, 6>::zero());
    }
    for (auto body = turning; body != turning_.end() && *body < end; ++body) part.orientations.push_back(s.orientation[*body - first]);
    return part;
}

}  // namespace catena
