#include "integrate/sites.hpp"

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

std::vector<Vec3> Sites::positions(ChainSystem::Snapshot const& s) const {
    std::vector<Vec3> all;
    if (s.position.empty()) return all;
    all.reserve(sites_.size());
    for (Site const& site : sites_) all.push_back(s.position[site.body] + to_matrix(s.orientation[site.body]) * site.place);
    return all;
}

std::vector<Vec3> Sites::velocities(ChainSystem::Snapshot const& s) const {
    std::vector<Vec3> all;
    if (s.velocity.empty()) return all;
    all.reserve(sites_.size());
    for (Site const& site : sites_)
        all.push_back(s.velocity[site.body] + to_matrix(s.orientation[site.body]) * cross(s.omega[site.body], site.place));
    return all;
}

std::vector<Quat> Sites::orientations(ChainSystem::Snapshot const& s) const {
    std::vector<Quat> all;
    if (s.orientation.empty()) return all;
    for (std::size_t const body : turning_) all.push_back(s.orientation[body]);
    return all;
}

std::vector<Vector<double, 6>> Sites::joint_forces(std::vector<Vector<double, 6>> const& of_bodies) const {
    std::vector<Vector<double, 6>> all;
    if (of_bodies.empty()) return all;
    all.reserve(sites_.size());
    for (Site const& site : sites_) all.push_back(site.is_first ? of_bodies[site.body] : Vector<double, 6>::zero());
    return all;
}

}  // namespace catena
