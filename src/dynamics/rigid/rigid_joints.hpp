// Joints and links of rigid bodies in absolute coordinates, in any Space: where handles are, how
// far joints are open, and what the solver is given of that. Ground axes are W, body axes are B.
#pragma once

#include <cmath>

#include "dca/solver.hpp"
#include "dynamics/rigid/joint_rotors.hpp"
#include "dynamics/rigid/rigid_model.hpp"
#include "kinematics/link_geometry.hpp"
#include "kinematics/ring_ends.hpp"

namespace catena {

/// Jointed tips of bodies, as plain pointers for loops over bodies.
struct HeldTipsView {
    /// Index of each body in `tip` if it is a last body with a jointed tip, else -1. Null if the
    /// group has no tips.
    std::int32_t const* jointed_tip = nullptr;
    HeldTip const* tip = nullptr;

    /// Attachment of the tip of body k; null if body k is not a last body or its tip is free.
    CATENA_HD HeldTip const* of(std::int64_t k) const {
        return jointed_tip && jointed_tip[k] >= 0 ? tip + jointed_tip[k] : nullptr;
    }
};
/// Storage behind HeldTipsView.
template <class Space>
class HeldTipsIn {
  public:
    HeldTipsIn(ChainGroup const& group, std::vector<HeldTip> tips)
        : host_(std::move(tips)), jointed_tip_(group.ends.jointed_tip), tips_(host_) {}
    HeldTipsView view() const {
        return {host_.empty() ? nullptr : jointed_tip_.data(), tips_.data()};
    }

  private:
    std::vector<HeldTip> host_;  // On the host a List is a view.
    typename Space::template List<std::int32_t> jointed_tip_;
    typename Space::template List<HeldTip> tips_;
};

/// Handles of bodies and directions of links, W.
struct HandlesView {
    RingEndsView of_rings;
    /// Handles 1 and 2 of bodies: their positions, or their velocities during an evaluation.
    View<3> inboard, outboard;
    /// Unit directions of links, inboard and of tips.
    View<3> direction, tip_direction;
};
/// Storage behind HandlesView.
template <class Space>
struct HandlesIn {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;

    /// The group and the communicator must outlive this object.
    HandlesIn(ChainGroup const& group, Space const& space, Communicator const& communicator)
        : inboard(group.size),
          outboard(group.size),
          direction(group.linked ? group.size : 0),
          tip_direction(group.linked && group.ends.has_tips() ? group.size : 0),
          rings(group.ends.rings),
          of_rings(group, space, communicator) {}
    HandlesView view() {
        return {of_rings.view(), inboard.view(), outboard.view(), direction.view(),
                tip_direction.view()};
    }

    FieldOf<3> inboard, outboard, direction, tip_direction;
    typename Space::template List<LocalRing> rings;
    RingEnds<Space> of_rings;
};

/// Joints and links with the handles that they hold together, and the operations on those of one
/// body.
struct RigidJoints {
    RigidModel model;
    HeldTipsView tips;
    RigidState state;
    JointRotors rotors;
    HandlesView handles;
    /// Biases of inboard joints and tips; for a link, component 0 along its direction. The other
    /// directions of full handles stay 0.
    DirectionsView bias, tip_bias;

    /// Sets the positions of both handles of body k at the given pose.
    CATENA_HD void set_ends(std::int64_t k, Vec3 const& centre, Mat3 const& rotation) const {
        handles.inboard.store(k, centre + rotation * model.r1.load(k));
        handles.outboard.store(k, centre + rotation * model.r2.load(k));
    }
    CATENA_HD void set_ends(std::int64_t k) const {
        set_ends(k, state.position.load(k), state.axes(k));
    }
    /// Handle 1 of body k from handle 2 of its inboard neighbour, or from its anchor on the ground.
    CATENA_HD Vec3 apart(std::int64_t k) const {
        return handles.inboard.load(k) -
               (model.is_first[k] ? model.piece_of(k).anchor : handles.outboard.load(k - 1));
    }
    /// The attachment of a tip from handle 2 of its last body. `at_ground` is used if the tip is
    /// attached to the ground.
    CATENA_HD Vec3 apart(HeldTip const& t, Vec3 const& at_ground) const {
        return (t.ring < 0 ? at_ground : handles.of_rings.first.load(t.ring)) -
               handles.outboard.load(t.body);
    }
    CATENA_HD Vec3 apart(HeldTip const& t) const { return apart(t, t.anchor); }
    /// Direction and length of a link; both are zero for a joint.
    struct Link {
        Vec3 direction;
        double length;
    };
    CATENA_HD Link link(std::int64_t k) const {
        return model.linked ? Link{handles.direction.load(k), model.length.at(k, 0)}
                            : Link{Vec3::zero(), 0};
    }
    CATENA_HD Link link(HeldTip const& t) const {
        return {model.linked ? handles.tip_direction.load(t.body) : Vec3::zero(), t.length};
    }

    /// Sets the directions of the links of body k: inboard, and of its tip.
    CATENA_HD void set_directions(std::int64_t k) const {
        Vec3 const d = model.is_joined(k) ? apart(k) : Vec3::zero();
        handles.direction.store(k, model.is_joined(k) ? (1.0 / norm(d)) * d : d);
        HeldTip const* const t = tips.of(k);
        if (!t) return;
        Vec3 const at_tip = apart(*t);
        handles.tip_direction.store(k, (1.0 / norm(at_tip)) * at_tip);
    }
    /// Sets the direction of the link that closes a ring, as the inboard direction of the ring's
    /// first body.
    CATENA_HD void set_first_direction(LocalRing const& ring, std::int64_t i) const {
        if (ring.first < 0) return;
        Vec3 const d = handles.of_rings.first.load(i) - handles.of_rings.last.load(i);
        handles.direction.store(ring.first, (1.0 / norm(d)) * d);
    }
    /// Relative error of a link or joint with opening d.
    CATENA_HD double error_of(Vec3 const& d, double l) const {
        return model.linked ? std::fabs(norm(d) - l) / l : norm(d) / model.reach;
    }
    /// Constraint error of the inboard joint of body k and of its tip; the larger one.
    CATENA_HD double error(std::int64_t k) const {
        double const own = model.is_joined(k)
                               ? error_of(apart(k), model.linked ? model.length.at(k, 0) : 0.0)
                               : 0.0;
        HeldTip const* const t = tips.of(k);
        double const at_tip = t ? error_of(apart(*t), t->length) : 0.0;
        return at_tip > own || at_tip != at_tip ? at_tip : own;
    }
    /// Stores the bias of a joint along its directions.
    CATENA_HD void set_bias(DirectionsView const& out, std::int64_t k, Vec3 const& value) const {
        if (model.linked)
            out.at(k, 0) = value[0];
        else
            out.store<3>(k, value);
    }
    /// Opening of a joint, or length error of a link as component 0.
    CATENA_HD Vec3 opening(Vec3 const& d, Link const& l) const {
        return model.linked ? Vec3{{excess(d, l.length, 0.5 / l.length), 0, 0}} : d;
    }
    /// Sets the biases for a drift's sweep, after a flight has set the handles: `scale` times the
    /// openings of joints.
    CATENA_HD void set_openings(std::int64_t k, double scale) const {
        set_bias(bias, k, model.is_joined(k) ? scale * opening(apart(k), link(k)) : Vec3::zero());
        rotors.set_opening(bias, k, scale);
        if (HeldTip const* const t = tips.of(k))
            set_bias(tip_bias, k, scale * opening(apart(*t), link(*t)));
    }
    /// Velocity bias of a joint for accelerations, without the bodies' centripetal terms, which the
    /// solver adds. It is nonzero for links only.
    CATENA_HD Vec3 turning(Vec3 const& v, Link const& l) const {
        return model.linked ? Vec3{{velocity_bias(v, l.direction, l.length), 0, 0}} : Vec3::zero();
    }
    /// Sets the velocity biases of body k's joints. Precondition for links: handles hold
    /// velocities.
    CATENA_HD void set_turnings(std::int64_t k) const {
        Vec3 const before =
            model.is_first[k] || !model.linked ? Vec3::zero() : handles.outboard.load(k - 1);
        set_bias(
            bias, k,
            model.is_joined(k) ? turning(handles.inboard.load(k) - before, link(k)) : Vec3::zero());
        if (HeldTip const* const t = tips.of(k))
            set_bias(tip_bias, k, turning(apart(*t, Vec3::zero()), link(*t)));
    }
};

}  // namespace catena
