// Collection of a scene's beads, their links, neighbours and start positions.
#include "integrate/scene_beads.hpp"

#include <algorithm>

#include "scene/bead_links.hpp"
#include "scene/pose.hpp"

namespace catena {
namespace {

/// Adds the links of a chain whose first bead has that number.
void add_links(BeadSystem& system, ChainSpec const& chain, std::int64_t first) {
    for (auto const& [inboard, outboard, length] : scene::bead_links(chain))
        system.links.push_back({first + inboard, first + outboard, length});
}

/// Adds the beads and links of a bead chain.
void add_beads(BeadSystem& system, ChainSpec const& chain) {
    std::int64_t const first = system.size();
    system.mass.insert(system.mass.end(), chain.beads.mass.begin(), chain.beads.mass.end());
    system.residue.insert(system.residue.end(), chain.beads.residue.begin(),
                          chain.beads.residue.end());
    add_links(system, chain, first);
}

/// Adds the beads that a chain's bodies carry, and the links or neighbours between them.
void add_carried(BeadSystem& system, ChainSpec const& chain) {
    std::int64_t const first = system.size();
    CarriedBeads const& carried = chain.carried();
    system.mass.insert(system.mass.end(), carried.mass.begin(), carried.mass.end());
    system.residue.insert(system.residue.end(), carried.residue.begin(), carried.residue.end());
    for (std::size_t k = 0; k < chain.size(); ++k) {
        std::int64_t const begin = carried.offset[k], end = carried.offset[k + 1];
        if (end - begin > 1) system.rigid.emplace_back(first + begin, first + end);
        if (k == 0 || chain.is_linked()) continue;
        if (end > begin && begin > carried.offset[k - 1])
            system.neighbours.emplace_back(first + begin - 1, first + begin);
    }
    if (chain.is_linked()) add_links(system, chain, first);
    // A ring of two bodies has its neighbours already.
    bool const both_ends =
        carried.offset[1] > 0 && carried.offset[chain.size()] > carried.offset[chain.size() - 1];
    if (chain.is_ring() && !chain.is_linked() && both_ends && chain.size() > 2)
        system.neighbours.emplace_back(first,
                                       first + static_cast<std::int64_t>(carried.size()) - 1);
}

/// Adds the positions of a body's carried beads, W.
void add_positions(std::vector<Vec3>& positions, CarriedBeads const& carried, std::size_t body,
                   scene::Pose const& pose) {
    Mat3 const rotation = to_matrix(pose.orientation);
    for (auto b = static_cast<std::size_t>(carried.offset[body]);
         b < static_cast<std::size_t>(carried.offset[body + 1]); ++b)
        positions.push_back(pose.origin + rotation * carried.position[b]);
}

}  // namespace

BeadSystem bead_system_of(Scene const& scene) {
    BeadSystem system;
    system.chain_offset.push_back(0);
    for (ChainSpec const& chain : scene.chains) {
        if (chain.bead_count() == 0) continue;
        chain.is_beads() ? add_beads(system, chain) : add_carried(system, chain);
        system.chain_name.push_back(chain.name);
        system.chain_offset.push_back(system.size());
    }
    system.box = scene.box;
    system.scene_file = scene.file;
    system.threads = scene.solver.threads;
    system.replicas = scene.replicas;
    return system;
}

std::vector<Vec3> bead_positions_of(Scene const& scene) {
    std::vector<Vec3> positions;
    for (ChainSpec const& chain : scene.chains) {
        positions.insert(positions.end(), chain.beads.position.begin(), chain.beads.position.end());
        if (chain.is_beads() || chain.bead_count() == 0) continue;
        scene::Pose pose;
        for (std::size_t k = 0; k < chain.size(); ++k) {
            if (chain.is_linked()) {
                auto const& q = chain.linked.orientation[k];
                pose = {{q[0], q[1], q[2], q[3]}, chain.linked.position[k]};
            } else {
                pose = scene::next_pose(chain.bodies, k, pose);
            }
            add_positions(positions, chain.carried(), k, pose);
        }
    }
    return positions;
}

}  // namespace catena
