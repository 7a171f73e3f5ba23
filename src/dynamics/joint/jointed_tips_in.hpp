// Jointed tips of a group in any Space.
#pragma once

#include "dynamics/joint/jointed_tips.hpp"

namespace catena {

/// Jointed tips of the group on this rank at the scene's start. Collective.
std::vector<JointedTip> tips_at_start(ChainGroup const&, Scene const&, Communicator const&);

/// Jointed tips with the motions of their two sides, and the loops over them.
template <class Space>
class JointedTipsIn {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;

  public:
    /// `reach`: characteristic length (reach_of()). The group and the communicator must outlive
    /// this object. Collective.
    JointedTipsIn(ChainGroup const& group, Scene const& scene, Space const& space,
                  Communicator const& communicator, double reach)
        : space_(space),
          communicator_(communicator),
          reach_(reach),
          directions_(group.directions),
          host_(tips_at_start(group, scene, communicator)),
          tips_(host_),
          last_end_(count()),
          other_end_(count()),
          bias_(group.ends.has_tips() ? group.size : 0, group.directions) {
        if (count() > 0)
            space_.edit(other_end_, [&](View<13> view) {
                for (std::int64_t i = 0; i < count(); ++i)
                    view.store(i, as_numbers(host_[static_cast<std::size_t>(i)].ground));
            });
    }

    std::int64_t count() const { return std::ssize(host_); }
    /// LoadsView::tip_bias.
    typename Space::Directions& bias() { return bias_; }
    JointedTips view(MotionView const& motion) {
        return {tips_.data(), reach_, directions_, motion, last_end_.view(), other_end_.view()};
    }
    /// Sets the ends from the motion, and where the two bodies meet. Rings on two ranks exchange
    /// their ends.
    void set_ends(MotionView const& motion) {
        JointedTips const t = view(motion);
        space_.for_each(count(), [t] CATENA_LAMBDA(std::int64_t i) { t.take_ends(i); });
        for (std::int64_t i = 0; i < count(); ++i) {
            JointedTip const& tip = host_[static_cast<std::size_t>(i)];
            if (tip.neighbour < 0) continue;
            bool const has_last = tip.body >= 0;
            View<13> const own = (has_last ? last_end_ : other_end_).view(),
                           other = (has_last ? other_end_ : last_end_).view();
            space_.exchange(communicator_,
                            BodyExchange<13>{own, i, tip.neighbour, other, i, tip.neighbour});
        }
        space_.for_each(count(), [t] CATENA_LAMBDA(std::int64_t i) { t.set_meeting(i); });
    }
    /// Sets bias() for accelerations (JointedTips::set_acceleration_bias()).
    void set_acceleration_bias(MotionView const& motion, Vec3 const& gravity) {
        space_.for_each(count(), [t = view(motion), gravity, out = bias_.view()] CATENA_LAMBDA(
                                     std::int64_t i) { t.set_acceleration_bias(i, gravity, out); });
    }
    /// Sets bias() for a correction (JointedTips::set_opening()).
    void set_opening(MotionView const& motion, bool velocities) {
        space_.for_each(count(), [t = view(motion), velocities, out = bias_.view()] CATENA_LAMBDA(
                                     std::int64_t i) { t.set_opening(i, velocities, out); });
    }
    /// Sets bias() to zero.
    void set_no_bias(MotionView const& motion) {
        space_.for_each(count(), [t = view(motion), out = bias_.view()] CATENA_LAMBDA(
                                     std::int64_t i) { t.set_no_bias(i, out); });
    }
    /// Largest JointedTips::error() on this rank.
    double error(MotionView const& motion) {
        return space_.largest(count(), [t = view(motion)] CATENA_LAMBDA(std::int64_t i) -> double {
            return t.error(i);
        });
    }

  private:
    Space space_;
    Communicator const& communicator_;
    double reach_;
    int directions_;
    /// Tips on the host, and their copy in the Space.
    std::vector<JointedTip> host_;
    typename Space::template List<JointedTip> tips_;
    FieldOf<13> last_end_, other_end_;  // Motions of tips' two sides.
    typename Space::Directions bias_;
};

}  // namespace catena
