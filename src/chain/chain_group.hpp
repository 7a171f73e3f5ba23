// The model in memory: the chains of a scene that share one kind of handle, as arrays over the bodies this rank holds.
// Local body k = 0 .. size-1; -1 and size are the neighbours' bodies (halo), valid where a chain goes on across the rank's end.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "chain/field.hpp"
#include "dca/tree.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Axes of a handle's directions. joint: those of the joint frame (state in joint coordinates). world: ground axes (absolute coordinates).
enum class Axes { joint, world };

struct ChainGroup {
    bool beads = false;
    Axes axes = Axes::joint;
    Handles handles = Handles::projected;
    int directions = 6;  // K: what a handle carries
    bool has_revolute = false;
    std::vector<int> chain;  // index in the scene of each chain of the group
    std::vector<std::string> name;
    std::vector<Base> base;                    // one a chain
    std::vector<std::int64_t> first_in_scene;  // scene-wide index of each chain's first body (bodies counted over all chains of the scene)
    dca::Partition partition;
    std::vector<dca::Piece> pieces;  // of this rank
    dca::Schedule schedule;

    // Local arrays.
    std::int64_t size = 0;
    std::vector<std::uint8_t> is_first, is_last;  // of its chain
    std::vector<std::uint8_t> restricted;         // restricted directions of the inboard joint (0: none; a free base)
    std::vector<JointType> joint;
    Field<1> mass, inverse_mass;
    // beads
    Field<1> length;  // of the inboard link
    // bodies
    Field<6> inertia, inverse_inertia;  // about the centre of mass, B (lower triangle: xx yx yy zx zy zz)
    Field<3> r1, r2;                    // inboard and outboard joint from the centre of mass, B
    Field<9> axes1;                     // joint's axes (last column: its axis) in J; the same components in B turn with the joint
    Field<9> axes2;                     // the outboard joint's axes in B
    Field<4> joint_rotation;            // quaternion of J of the inboard joint in the inboard body's axes (first body: W)
    Field<3> joint_translation;         // origin of J from the inboard body's origin, its axes (first body: W)

    int neighbour_inboard = -1, neighbour_outboard = -1;  // ranks that hold the bodies before and after, where a chain goes on there
    char const* kind() const;                             // smallest handle kind that holds the chains: link | spherical | revolute
    /// Restricted directions of joint k of local numbering, those of shared chains' tops included (schedule.joints entries; `none`: 0).
    std::vector<std::uint8_t> restricted_of_joint;
    /// Global body index over the scene of local body k.
    std::int64_t scene_index(std::int64_t k) const;
    std::vector<std::int64_t> const& first_of_rank() const { return partition.first_of_rank; }
};

/// Fills halos of a field: entry size from the outboard neighbour's first body, entry -1 from the inboard neighbour's last one.
template <int D>
void exchange_from_outboard(Communicator const& communicator, ChainGroup const& group, View<D> field) {
    if (group.neighbour_inboard < 0 && group.neighbour_outboard < 0) return;
    Vector<double, D> send = field.load(0), receive = field.load(group.size);
    communicator.exchange(std::as_bytes(std::span(send.data)), group.neighbour_inboard, std::as_writable_bytes(std::span(receive.data)),
                          group.neighbour_outboard);
    if (group.neighbour_outboard >= 0) field.store(group.size, receive);
}
template <int D>
void exchange_from_inboard(Communicator const& communicator, ChainGroup const& group, View<D> field) {
    if (group.neighbour_inboard < 0 && group.neighbour_outboard < 0) return;
    Vector<double, D> send = field.load(group.size - 1), receive = field.load(-1);
    communicator.exchange(std::as_bytes(std::span(send.data)), group.neighbour_outboard, std::as_writable_bytes(std::span(receive.data)),
                          group.neighbour_inboard);
    if (group.neighbour_inboard >= 0) field.store(-1, receive);
}

/// Groups the scene's chains: all bead chains in one, body chains in one. `pairwise` chooses the chapter's tree.
std::vector<std::unique_ptr<ChainGroup>> make_groups(Scene const&, Axes, Handles, bool pairwise, Communicator const&);

}  // namespace catena
