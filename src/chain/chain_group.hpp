// Model of the chains of a scene that share one handle kind, as arrays over the bodies that this
// rank owns. Local bodies are k = 0 .. size-1. Entries -1 and size are the halo, the neighbouring
// ranks' bodies; they are valid if a chain continues beyond the rank's end.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "chain/group_view.hpp"
#include "chain/local_model.hpp"
#include "math/executor.hpp"
#include "mpi/collectives.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"
#include "tree/load_balance.hpp"
#include "tree/tree.hpp"

namespace catena {

/// Axes of a handle's directions. joint: axes of the joint frame (state in joint coordinates).
/// world: ground axes W (absolute coordinates).
enum class Axes { joint, world };

/// Chains of one handle kind. Two bodies meet at a joint in its meeting frame M. M is the joint
/// frame J, with two exceptions. For a universal joint, M is J rotated about the first axis; for a
/// joint that translates, M moves with the outboard body's origin. The last column of a joint's
/// axes is its axis. For a universal joint the columns are the normal to both axes, the third unit
/// vector, and the second axis. For a planar3 joint they are the axes of its translations and the
/// normal.
struct ChainGroup {
    bool beads = false;   // true for point beads on links
    bool linked = false;  // true for rigid bodies and point beads on links
    /// True if all joints are revolute with parallel axes; then the two directions of the plane
    /// suffice.
    bool planar = false;
    /// True for bodies on projected handles whose joints are revolute, except for the first joints
    /// of chains; tips are free, and there are no loops.
    bool revolute = false;
    Axes axes = Axes::joint;
    Handles handles = Handles::projected;
    int directions = 6;           // K, the number of directions of a handle
    int smallest_directions = 6;  // number of directions that would suffice
    std::vector<GroupChain> chains;
    dca::Partition partition;
    std::vector<dca::Piece> pieces;  // pieces of this rank
    dca::Schedule schedule;
    /// Number of local bodies.
    std::int64_t size = 0;
    LocalEnds ends;
    LocalJoints joints;
    LocalBodies bodies;
    Branching branching;
    LocalLoops loops;
    LocalBeads carried;
    NeighbourRanks neighbours;

    /// View of the arrays in host memory.
    GroupView view() const;
    /// Masses and inertias that sweeps read: those of articulated handles and of runs on revolute
    /// joints. Empty for other groups.
    Field<1> const& mass_of_sweeps() const;
    Field<6> const& inertia_of_sweeps() const;
    /// True if sweeps read masses and inertias.
    bool sweeps_read_inertias() const;
    /// Name of the smallest handle kind: link | planar | spherical | universal | revolute | full.
    char const* kind() const;
    /// True if some chain of the group has a jointed tip or loops, on any rank.
    bool has_closures() const { return ends.has_tips() || loops.in_scene; }
    bool is_branched() const { return branching.paths.of_all_ranks.paths > 0; }
    /// Entry of the first cross-link in arrays over links.
    std::int64_t first_crosslink() const { return size + 1; }
    /// Number of entries of arrays over links: those of the bodies, one of the halo, and those of
    /// cross-links, if there are any.
    std::int64_t link_entries() const {
        return branching.crosslinks.empty() ? size
                                            : first_crosslink() + std::ssize(branching.crosslinks);
    }
    /// Number of constrained directions of local body k's inboard joint, at most `directions`.
    /// Driven and implicit joints count as constrained in all directions.
    int restricted(std::int64_t k) const;
    /// Index in `pieces` of the piece that contains local body k.
    std::size_t index_of_piece(std::int64_t k) const;
    /// Scene-wide index of local body k.
    std::int64_t scene_index(std::int64_t k) const;
    /// Index in the scene of the chain that contains local body k.
    int scene_chain(std::int64_t k) const;
    /// First body of each rank in the group's numbering; [ranks + 1].
    std::vector<std::int64_t> const& first_of_rank() const { return partition.first_of_rank; }
};

/// Returns the tip joint of a chain of the group, whose `directions` and `planar` must be set.
/// `last`: local index of the chain's last body.
LocalTip local_tip(ChainGroup const&, ChainSpec const&, std::int64_t last);

/// Returns the local indices of the last bodies to which the tips belong, in the same order.
std::vector<std::int64_t> last_bodies(std::vector<LocalTip> const&);

/// Exchange of one body's numbers with neighbouring ranks: sends body i of `from` to rank `to`, and
/// receives body j of `into` from rank `source`. A negative rank means no message.
template <int D>
struct BodyExchange {
    ConstView<D> from;
    std::int64_t i;
    int to;
    View<D> into;
    std::int64_t j;
    int source;

    static constexpr int numbers = D;
    /// Exchange without messages.
    static BodyExchange none() { return {{}, 0, -1, {}, 0, -1}; }
    explicit operator bool() const { return to >= 0 || source >= 0; }
};
/// Traffic of an exchange on this rank.
template <int D>
Traffic traffic_of(BodyExchange<D> const& e) {
    Traffic message;
    message.exchanges = e ? 1 : 0;
    message.sent_bytes = e.to >= 0 ? D * static_cast<std::int64_t>(sizeof(double)) : 0;
    return message;
}
/// Carries out an exchange through host memory. `access` reads and writes bodies in any memory.
template <int D, class Access>
void exchange_by_host(Access const& access, Communicator const& communicator,
                      BodyExchange<D> const& e) {
    if (!e) return;
    Vector<double, D> const send = access.get(e.from, e.i);
    Vector<double, D> receive = send;
    exchange(communicator, send.data, e.to, receive.data, e.source);
    if (e.source >= 0) access.put(e.into, e.j, receive);
}
/// Access to the bodies of fields in host memory.
struct HostAccess {
    template <int D>
    Vector<double, D> get(ConstView<D> field, std::int64_t k) const {
        return field.load(k);
    }
    template <int D>
    void put(View<D> field, std::int64_t k, Vector<double, D> const& value) const {
        field.store(k, value);
    }
    /// Exchanges a body, here by exchange_by_host(). Other access types may have a shorter path.
    template <int D>
    void exchange(Communicator const& communicator, BodyExchange<D> const& e) const {
        exchange_by_host(*this, communicator, e);
    }
    /// Calls first(0), then exchanges; does nothing without an exchange.
    template <int D, class First>
    void exchange(Communicator const& communicator, BodyExchange<D> const& e,
                  First const& first) const {
        if (!e) return;
        first(0);
        exchange(communicator, e);
    }
};
/// Exchange that fills halo entry `size` of a field with the outboard neighbour's first body.
template <int D>
BodyExchange<D> from_outboard(ChainGroup const& group, View<D> field) {
    return {field, 0, group.neighbours.inboard, field, group.size, group.neighbours.outboard};
}
/// Fills halo entry `size` of a field with the outboard neighbour's first body. `access` reads and
/// writes bodies of the field. Collective among neighbours.
template <int D, class Access = HostAccess>
void exchange_from_outboard(Communicator const& communicator, ChainGroup const& group,
                            View<D> field, Access const& access = {}) {
    access.exchange(communicator, from_outboard(group, field));
}
/// Fills halo entry -1 of a field with the inboard neighbour's last body. Collective among
/// neighbours.
template <int D, class Access = HostAccess>
void exchange_from_inboard(Communicator const& communicator, ChainGroup const& group, View<D> field,
                           Access const& access = {}) {
    access.exchange(communicator, BodyExchange<D>{field, group.size - 1, group.neighbours.outboard,
                                                  field, -1, group.neighbours.inboard});
}

/// Canonical unit of the tree on this rank. Chain-wide compositions proceed unit by unit,
/// independently of the number of ranks.
struct LocalUnit {
    std::size_t piece = 0;
    std::int64_t begin = 0, count = 0;  // local bodies
    std::int64_t index = 0;             // index of the unit in its chain
};
/// Returns the units of this rank along the chains.
std::vector<LocalUnit> local_units(ChainGroup const&);

/// Gathers a value of every unit of shared chains, chain after chain, in one collective. `own` has
/// one value for each of this rank's units. The result is empty if no chain is shared.
template <class Value>
std::vector<Value> gather_shared_units(Communicator const& communicator, ChainGroup const& group,
                                       std::vector<LocalUnit> const& units,
                                       std::vector<Value> const& own) {
    if (group.schedule.shared.empty()) return {};
    std::vector<Value> send;
    std::vector<std::int64_t> counts(static_cast<std::size_t>(communicator.size()), 0);
    for (dca::FrontierUnit const& unit : group.schedule.shared) ++counts[unit.owner];
    for (std::size_t i = 0; i < units.size(); ++i)
        if (!group.pieces[units[i].piece].whole()) send.push_back(own[i]);
    return all_gathered(communicator, send, counts);
}

/// Calls action(piece, i) for body i of every piece, on the executor's threads.
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

/// Options of make_groups().
struct GroupOptions {
    /// True if springs and dampers are implicit. Joints with them then carry all six directions,
    /// with their effect on the matrices along the free ones; their chains have full handles.
    bool implicit = false;
    dca::Shares shares;                        // shares of the bodies of every group, per rank
    Executor const& executor = this_thread();  // executor of loops over bodies
};
/// Groups the scene's chains by their smallest handle kind; with full handles, by the kind of their
/// bodies. `pairwise` selects the chapter's tree of pairs. Collective.
std::vector<std::unique_ptr<ChainGroup>> make_groups(Scene const&, Axes, Handles, bool pairwise,
                                                     Communicator const&, GroupOptions const& = {});

}  // namespace catena
