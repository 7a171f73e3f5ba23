// First and last bodies of rings (chains closed on themselves), in any Space. If the two ends of a
// ring are on different ranks, the ranks exchange them.
#pragma once

#include "dca/host_space.hpp"
#include "kinematics/link_geometry.hpp"
#include "mpi/collectives.hpp"

namespace catena {

/// For each of the group's tips, of_first(k) of the ring's first body k, on whatever rank that body
/// is. Tips joined to the ground have zero. Collective if a ring spans two ranks.
template <int D, class Of>
std::vector<Vector<double, D>> beyond_tips_of(ChainGroup const& group,
                                              Communicator const& communicator,
                                              Of const& of_first) {
    std::vector<Vector<double, D>> all(group.ends.tips.size(), Vector<double, D>::zero());
    for (LocalRing const& ring : group.ends.rings) {
        Vector<double, D> const own =
            ring.first >= 0 ? of_first(ring.first) : Vector<double, D>::zero();
        Vector<double, D> found = own;
        if (!ring.is_whole())
            exchange(communicator, own.data, ring.neighbour, found.data, ring.neighbour);
        if (ring.last >= 0) all[group.ends.tip_index(ring.last)] = found;
    }
    return all;
}

/// Vectors of rings' end bodies, such as positions: one of the first body and one of the last.
/// Indexed as LocalEnds::rings.
struct RingEndsView {
    View<3> first, last;
};

/// Copies of vectors of rings' end bodies, on each rank that holds one of the ends.
template <class Space>
class RingEnds {
  public:
    /// The group and the communicator must outlive this object.
    RingEnds(ChainGroup const& group, Space const& space, Communicator const& communicator)
        : group_(group),
          space_(space),
          communicator_(communicator),
          rings_(group.ends.rings),
          first_(std::ssize(group.ends.rings)),
          last_(std::ssize(group.ends.rings)) {}

    RingEndsView view() { return {first_.view(), last_.view()}; }
    /// Copies the vectors of end bodies from fields over bodies, and exchanges them between ranks.
    /// Collective if a ring spans two ranks.
    void take(View<3> of_first, View<3> of_last) {
        if (group_.ends.rings.empty()) return;
        space_.for_each(
            std::ssize(group_.ends.rings),
            [ring = rings_.data(), ends = view(), of_first, of_last] CATENA_LAMBDA(std::int64_t i) {
                if (ring[i].first >= 0) ends.first.store(i, of_first.load(ring[i].first));
                if (ring[i].last >= 0) ends.last.store(i, of_last.load(ring[i].last));
            });
        for (std::int64_t i = 0; i < std::ssize(group_.ends.rings); ++i) {
            LocalRing const& ring = group_.ends.rings[static_cast<std::size_t>(i)];
            if (!ring.is_whole()) exchange(i, ring);
        }
    }

  private:
    /// Sends this rank's end of ring i and receives the other end.
    void exchange(std::int64_t i, LocalRing const& ring) {
        View<3> const own = (ring.first >= 0 ? first_ : last_).view(),
                      other = (ring.first >= 0 ? last_ : first_).view();
        space_.exchange(communicator_,
                        BodyExchange<3>{own, i, ring.neighbour, other, i, ring.neighbour});
    }

    ChainGroup const& group_;
    Space space_;
    Communicator const& communicator_;
    typename Space::template List<LocalRing> rings_;
    typename Space::template FieldOf<3> first_, last_;
};

}  // namespace catena
