// The model in memory: the chains of a scene that share one kind of handle, as arrays over the
// bodies this rank holds. Local body k = 0 .. size-1; -1 and size are the neighbours' bodies
// (halo), valid where a chain goes on across the rank's end.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "chain/group_view.hpp"
#include "math/executor.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"
#include "tree/load_balance.hpp"
#include "tree/tree.hpp"

namespace catena {

/// Axes of a handle's directions. joint: those of the joint frame (state in joint coordinates).
/// world: ground axes (absolute coordinates).
enum class Axes { joint, world };

/// A chain's joint from its last body to the ground or to its first body, where this rank holds
/// that last body.
struct LocalTip {
    std::int64_t body = 0;  // local
    TipJoint joint;
    Mat3 axes;   // its axes in the meeting frame, as ChainGroup::axes1
    Vec3 screw;  // as ChainGroup::screw
    int restricted = 0;
};

/// A chain closed on itself, one end of which at least is on this rank.
struct LocalRing {
    int chain = 0;                       // of the group
    std::int64_t first = -1, last = -1;  // its first and last bodies, local; -1 on another rank
    int neighbour = -1;                  // the rank that holds the other end; -1: this one does
    bool is_whole() const { return neighbour < 0; }
};

/// A joint that follows a prescribed course, on this rank.
struct LocalDrive {
    std::int64_t body = 0;           // local: the joint's outboard body
    PrescribedMotion first, second;  // universal: both
};

/// Two bodies meet at a joint in its meeting frame M: the joint frame J, but for a universal joint,
/// where it is J turned about the first axis, and for sliding joints, where it moves with the
/// outboard body along the axis. The last column of a joint's axes is its axis; of a universal
/// joint the columns are (normal to both axes, -, second axis).
struct ChainGroup {
    bool beads = false;   // point beads on links
    bool linked = false;  // rigid bodies and point beads on links
    bool planar = false;  // revolute, all axes parallel: the plane's two directions are enough
    Axes axes = Axes::joint;
    Handles handles = Handles::projected;
    int directions = 6;           // K: what a handle carries
    int smallest_directions = 6;  // what would be enough
    bool has_universal = false, has_screws = false;
    bool revolute = false;  // bodies on projected handles whose joints, but those of chains' first
                            // ones, are revolute; tips are free
    std::vector<std::uint8_t> implicit_joint;  // of local body k: its springs and dampers stand in
                                               // the matrices; empty where none does
    std::vector<int> chain;                    // index in the scene of each chain of the group
    std::vector<std::string> name;
    std::vector<Base> base;                    // one a chain
    std::vector<std::int64_t> first_in_scene;  // scene-wide index of each chain's first body
                                               // (bodies counted over all chains of the scene)
    dca::Partition partition;
    std::vector<dca::Piece> pieces;  // of this rank
    dca::Schedule schedule;

    // Local arrays.
    std::int64_t size = 0;
    std::vector<std::uint8_t> is_first, is_last;  // of its chain
    bool tips_in_scene = false;  // some chain of the group has a jointed tip, on whatever rank
    std::vector<std::int32_t>
        jointed_tip;  // of its last body: index in `tips`, else -1; empty where none has
    std::vector<JointType> joint;
    Field<1> mass, inverse_mass;
    // links
    Field<1> length;  // of the inboard link
    // bodies
    Field<6> inertia,
        inverse_inertia;  // about the centre of mass, B (lower triangle: xx yx yy zx zy zz);
                          // planar: the inverse about the axis
    Field<3> r1,
        r2;  // inboard and outboard joint from the centre of mass, B (sliding outboard joint: at q
             // = 0); of a last body whose tip nobody holds r2 and axes2 are as of the body before
    Field<6>
        axes1;  // joint's axes in M (kept_axes()); the same components in B turn with the joint
    Field<6> axes2;           // the outboard joint's axes in B (universal: at q = 0)
    Field<4> joint_rotation;  // quaternion of J of the inboard joint in the inboard body's axes
                              // (first body: W)
    Field<3>
        joint_translation;  // origin of J from the inboard body's origin, its axes (first body: W)
    Field<3> first_axis;    // of a universal joint, J; empty where there is none
    Field<3> screw;  // {c, s, rate}: the joint turns by c rate q about its axis and slides by s
                     // rate q along it; empty where no joint slides
    bool carried_in_scene = false;  // some body of the group carries beads, on whatever rank
    std::vector<std::int64_t>
        bead_offset;               // size + 1: beads that body k carries; empty where none does
    std::vector<Vec3> bead_place;  // of carried beads from the centre of mass, B
    std::vector<LocalDrive> drives;
    std::vector<LocalTip> tips;
    std::vector<Vec3> tip_screw;  // of `tips`
    std::vector<LocalRing> rings;

    int neighbour_inboard = -1,
        neighbour_outboard =
            -1;  // ranks that hold the bodies before and after, where a chain goes on there
    GroupView view() const;
    /// What sweeps read of `mass` and `inertia`: those of articulated handles and of runs on
    /// revolute joints. Else empty.
    Field<1> const& mass_of_sweeps() const;
    Field<6> const& inertia_of_sweeps() const;
    bool sweeps_read_inertias() const;
    char const* kind()
        const;  // smallest handle kind: link | planar | spherical | universal | revolute | full
    /// Restricted directions of joint k of local numbering, the halo's, tips' and those of shared
    /// chains' tops included (schedule.joints entries; `none`: 0).
    std::vector<std::uint8_t> restricted_of_joint;
    bool has_jointed_tip(std::int64_t k) const {
        return !jointed_tip.empty() && jointed_tip[static_cast<std::size_t>(k)] >= 0;
    }
    /// Precondition: has_jointed_tip(k).
    std::size_t tip_index(std::int64_t k) const {
        return static_cast<std::size_t>(jointed_tip[static_cast<std::size_t>(k)]);
    }
    LocalTip const& tip_of(std::int64_t k) const { return tips[tip_index(k)]; }
    std::int64_t carried_beads() const { return bead_offset.empty() ? 0 : bead_offset.back(); }
    bool has_tips() const { return tips_in_scene; }
    /// Whether handle 2 of a body depends on the joint there.
    bool moving_meeting() const { return has_universal || has_screws; }
    bool is_driven(std::int64_t k) const;
    bool is_implicit(std::int64_t k) const {
        return !implicit_joint.empty() && implicit_joint[static_cast<std::size_t>(k)] != 0;
    }
    /// Restricted directions of local body k's inboard joint, of those that the handles carry.
    int restricted(std::int64_t k) const;
    /// Of `pieces`: the one that local body k is in.
    std::size_t index_of_piece(std::int64_t k) const;
    /// Global body index over the scene of local body k.
    std::int64_t scene_index(std::int64_t k) const;
    /// Index in the scene of the chain that local body k belongs to.
    int scene_chain(std::int64_t k) const;
    std::vector<std::int64_t> const& first_of_rank() const { return partition.first_of_rank; }
};

/// Of a chain of the group, with directions and planarity known. `last`: its last body, local.
LocalTip local_tip(ChainGroup const&, ChainSpec const&, std::int64_t last);

/// That the tips belong to, local, in their order.
std::vector<std::int64_t> last_bodies(std::vector<LocalTip> const&);

/// Body i of `from` to rank `to`, and from rank `source` into body j of `into`; a negative rank
/// means nobody.
template <int D>
struct BodyExchange {
    ConstView<D> from;
    std::int64_t i;
    int to;
    View<D> into;
    std::int64_t j;
    int source;

    static constexpr int numbers = D;
    static BodyExchange none() { return {{}, 0, -1, {}, 0, -1}; }
    explicit operator bool() const { return to >= 0 || source >= 0; }
};
template <int D>
Traffic traffic_of(BodyExchange<D> const& e) {
    Traffic message;
    message.exchanges = e ? 1 : 0;
    message.sent_bytes = e.to >= 0 ? D * static_cast<std::int64_t>(sizeof(double)) : 0;
    return message;
}
/// By the host: `access` gets and puts bodies, wherever they are.
template <int D, class Access>
void exchange_by_host(Access const& access, Communicator const& communicator,
                      BodyExchange<D> const& e) {
    if (!e) return;
    Vector<double, D> const send = access.get(e.from, e.i);
    Vector<double, D> receive = send;
    communicator.exchange(std::as_bytes(std::span(send.data)), e.to,
                          std::as_writable_bytes(std::span(receive.data)), e.source);
    if (e.source >= 0) access.put(e.into, e.j, receive);
}
/// Access to a field's bodies on the host.
struct HostAccess {
    template <int D>
    Vector<double, D> get(ConstView<D> field, std::int64_t k) const {
        return field.load(k);
    }
    template <int D>
    void put(View<D> field, std::int64_t k, Vector<double, D> const& value) const {
        field.store(k, value);
    }
    /// exchange_by_host(), or a shorter way.
    template <int D>
    void exchange(Communicator const& communicator, BodyExchange<D> const& e) const {
        exchange_by_host(*this, communicator, e);
    }
    /// After first(0), where there is an exchange.
    template <int D, class First>
    void exchange(Communicator const& communicator, BodyExchange<D> const& e,
                  First const& first) const {
        if (!e) return;
        first(0);
        exchange(communicator, e);
    }
};
/// Of a field's halos: entry size, from the outboard neighbour's first body.
template <int D>
BodyExchange<D> from_outboard(ChainGroup const& group, View<D> field) {
    return {field, 0, group.neighbour_inboard, field, group.size, group.neighbour_outboard};
}
/// Fills halos of a field: entry size from the outboard neighbour's first body, entry -1 from the
/// inboard neighbour's last one. `access` reads and writes bodies of the field, wherever it is.
template <int D, class Access = HostAccess>
void exchange_from_outboard(Communicator const& communicator, ChainGroup const& group,
                            View<D> field, Access const& access = {}) {
    access.exchange(communicator, from_outboard(group, field));
}
template <int D, class Access = HostAccess>
void exchange_from_inboard(Communicator const& communicator, ChainGroup const& group, View<D> field,
                           Access const& access = {}) {
    access.exchange(communicator, BodyExchange<D>{field, group.size - 1, group.neighbour_outboard,
                                                  field, -1, group.neighbour_inboard});
}

/// A canonical unit of the tree on this rank: what composes along a chain does so unit by unit,
/// whatever the number of ranks.
struct LocalUnit {
    std::size_t piece = 0;
    std::int64_t begin = 0, count = 0;  // local bodies
    std::int64_t index = 0;             // within its chain
};
std::vector<LocalUnit> local_units(ChainGroup const&);

/// One collective: a value of every unit of chains that several ranks share, chain after chain,
/// from those of the ranks' own units (`own`, one a local unit). Empty where no chain is shared.
template <class Value>
std::vector<Value> gather_shared_units(Communicator const& communicator, ChainGroup const& group,
                                       std::vector<LocalUnit> const& units,
                                       std::vector<Value> const& own) {
    std::vector<Value> send, all(group.schedule.shared.size());
    if (all.empty()) return all;
    std::vector<std::int64_t> bytes(static_cast<std::size_t>(communicator.size()), 0);
    for (dca::FrontierUnit const& unit : group.schedule.shared) bytes[unit.owner] += sizeof(Value);
    for (std::size_t i = 0; i < units.size(); ++i)
        if (!group.pieces[units[i].piece].whole()) send.push_back(own[i]);
    communicator.all_gather(std::as_bytes(std::span(send)), std::as_writable_bytes(std::span(all)),
                            bytes);
    return all;
}

/// action(piece, i) for body i of every piece, on the executor's threads.
template <class Action>
void each_local_body(ChainGroup const& group, Executor const& executor, Action const& action) {
    executor.for_ranges(group.size, 1, [&](std::int64_t begin, std::int64_t end) {
        std::size_t p = group.index_of_piece(begin);
        for (std::int64_t k = begin; k < end; ++k) {
            while (k >= group.pieces[p].local + group.pieces[p].count) ++p;
            action(group.pieces[p], k - group.pieces[p].local);
        }
    });
}

struct GroupOptions {
    /// Joints with springs or dampers carry all six directions, along the free ones what these do
    /// to the matrices; their chains have full handles.
    bool implicit = false;
    dca::Shares shares;                        // of the bodies of every group, rank by rank
    Executor const& executor = this_thread();  // for loops over bodies
};
/// Groups the scene's chains by the smallest handle kind that holds them (full handles: by what
/// they consist of). `pairwise` chooses the chapter's tree.
std::vector<std::unique_ptr<ChainGroup>> make_groups(Scene const&, Axes, Handles, bool pairwise,
                                                     Communicator const&, GroupOptions const& = {});

}  // namespace catena
