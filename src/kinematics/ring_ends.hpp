// Where chains closed on themselves begin and end, in any Space. Rings on two ranks show each other
// their ends.
#pragma once

#include "dca/host_space.hpp"
#include "kinematics/link_geometry.hpp"

namespace catena {

/// What `of_first(k)` says of the body that each of the group's tips is joined to: a ring's first
/// body k, on whatever rank it is; the ground: zero. Collective where a ring is on two ranks.
template <int D, class Of>
std::vector<Vector<double, D>> beyond_tips_of(ChainGroup const& group,
                                              Communicator const& communicator,
                                              Of const& of_first) {
    std::vector<Vector<double, D>> all(group.tips.size(), Vector<double, D>::zero());
    for (LocalRing const& ring : group.rings) {
        Vector<double, D> const own =
            ring.first >= 0 ? of_first(ring.first) : Vector<double, D>::zero();
        Vector<double, D> found = own;
        if (!ring.is_whole())
            communicator.exchange(std::as_bytes(std::span(own.data)), ring.neighbour,
                                  std::as_writable_bytes(std::span(found.data)), ring.neighbour);
        if (ring.last >= 0) all[group.tip_index(ring.last)] = found;
    }
    return all;
}

/// By ring (ChainGroup::rings): something of its first body, and something of its last.
struct RingEndsView {
    View<3> first, last;
};

template <class Space>
class RingEnds {
  public:
    /// The group and the communicator must outlive it.
    RingEnds(ChainGroup const& group, Space const& space, Communicator const& communicator)
        : group_(group),
          space_(space),
          communicator_(communicator),
          rings_(group.rings),
          first_(std::ssize(group.rings)),
          last_(std::ssize(group.rings)) {}

    RingEndsView view() { return {first_.view(), last_.view()}; }
    /// From fields over bodies. Collective where a ring is on two ranks.
    void take(View<3> of_first, View<3> of_last) {
        if (group_.rings.empty()) return;
        space_.for_each(std::ssize(group_.rings), [ring = rings_.data(), ends = view(), of_first,
                                                   of_last] CATENA_LAMBDA(std::int64_t i) {
            if (ring[i].first >= 0) ends.first.store(i, of_first.load(ring[i].first));
            if (ring[i].last >= 0) ends.last.store(i, of_last.load(ring[i].last));
        });
        for (std::int64_t i = 0; i < std::ssize(group_.rings); ++i) {
            LocalRing const& ring = group_.rings[static_cast<std::size_t>(i)];
            if (!ring.is_whole()) exchange(i, ring);
        }
    }

  private:
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
