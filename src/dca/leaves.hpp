// How the tree solver reads one body from the arrays: its matrices, its bias, and its acceleration once the joint forces are known.
#pragma once

#include "dca/leaf.hpp"
#include "dca/moving_beads.hpp"
#include "dca/solver.hpp"

namespace catena::dca {

template <int D>
CATENA_HD Vector<double, D> load_or_zero(ConstView<D> const& view, std::int64_t k) {
    return view.origin ? view.load(k) : Vector<double, D>::zero();
}

/// Direction of the link on the outboard side of body k; 0 where there is none.
CATENA_HD Vec3 outboard_direction(GroupView const& group, ConstView<3> direction, ConstView<3> tip_direction, std::int64_t k) {
    if (!group.is_last[k]) return direction.load(k + 1);
    return group.has_jointed_tip(k) ? tip_direction.load(k) : Vec3::zero();
}

/// The velocity terms of the inboard joint, and of a jointed tip: the ground's handle 1 there is as good as the body's handle 2.
template <int K>
CATENA_HD void add_joint_biases(GroupView const& group, LoadsView const& loads, std::int64_t k, SegmentBias<double, K>& b) {
    if (loads.bias) b.b1 = b.b1 + loads.bias.load<K>(k);
    if (loads.tip_bias && group.has_jointed_tip(k)) b.b2 = b.b2 - loads.tip_bias.load<K>(k);
}

/// What is wanted of the forces at body k's two joints.
template <int K>
CATENA_HD void store_forces(GroupView const& group, AccelerationsView const& out, std::int64_t k, Vector<double, K> const& inboard,
                            Vector<double, K> const& outboard) {
    if (out.joint_force) out.joint_force.template store<K>(k, inboard);
    if (out.tip_force && group.has_jointed_tip(k)) out.tip_force.template store<K>(k, outboard);
}

/// Point beads; K = 1 projected, 3 full.
template <int K_>
class BeadLeaf {
  public:
    static constexpr int K = K_;
    /// Whether matrices and biases in one sweep beat one sweep after the other: with more directions registers run out.
    static constexpr bool at_once = K == 1;
    using Moving = MovingBeads<K>;
    explicit BeadLeaf(GroupView const& group) : group_(group) {}
    void set(ConfigurationView const& c) {
        direction_ = c.direction;
        tip_direction_ = c.tip_direction;
    }
    CATENA_HD GroupView const& group() const { return group_; }

    CATENA_HD SegmentMatrix<double, K> matrix(std::int64_t k) const {
        return bead_matrix(group_.inverse_mass.at(k, 0), direction_.load(k), outboard(k), Vector<double, K>{});
    }
    CATENA_HD SegmentBias<double, K> bias(LoadsView const& loads, std::int64_t k) const {
        SegmentBias<double, K> b{Vector<double, K>::zero(), Vector<double, K>::zero()};
        if (loads.force.origin)
            b = bead_bias(group_.inverse_mass.at(k, 0), loads.force.load(k), direction_.load(k), outboard(k), Vector<double, K>{});
        add_joint_biases(group_, loads, k, b);
        return b;
    }
    CATENA_HD void accelerate(LoadsView const& loads, std::int64_t k, Vector<double, K> const& inboard_force,
                              Vector<double, K> const& outboard_force, AccelerationsView const& out) const {
        if (!out.acceleration.origin) return;
        out.acceleration.store(k, bead_acceleration(group_.inverse_mass.at(k, 0), load_or_zero(loads.force, k), inboard_force[0],
                                                    direction_.load(k), outboard_force[0], outboard(k)));
    }

  private:
    CATENA_HD Vec3 outboard(std::int64_t k) const { return outboard_direction(group_, direction_, tip_direction_, k); }
    GroupView group_;
    ConstView<3> direction_, tip_direction_;
};

/// The two handles of a body, and the rotation from B to the axes in which forces are kept.
template <int K>
struct HandlePair {
    Handle<double, K> h1, h2;
    Mat3 to_force_axes;
};

/// Joint coordinates: handles along the axes of the meeting frames, forces in B. `sliding`: prismatic and helical joints too.
template <int K, bool sliding>
class MeetingFrames {
  public:
    static constexpr bool any_forces = sliding, at_once = true;
    explicit MeetingFrames(GroupView const& group) : group_(group), axes2_(group.axes2), r2_(group.r2) {}
    void set(ConfigurationView const& c) {
        rotation_ = c.rotation;
        if (c.axes2.origin) axes2_ = c.axes2;
        if (c.r2.origin) r2_ = c.r2;
    }
    CATENA_HD Vec3 r1(std::int64_t k) const { return group_.r1.load(k); }
    CATENA_HD Vec3 r2(std::int64_t k) const { return r2_.load(k); }
    CATENA_HD HandlePair<K> handles(std::int64_t k) const {
        Vector<double, 4> const q = rotation_.load(k);
        Mat3 const e1 = transposed_times(to_matrix(as_quaternion(q)), as_matrix(group_.axes1.load(k)));
        Mat3 const e2 = as_matrix(axes2_.load(k));
        HandlePair<K> pair{make_handle<K>(r1(k), e1, e1), make_handle<K>(r2(k), e2, e2), Mat3::identity()};
        if constexpr (sliding) {
            Vec3 const s1 = group_.screw.load(k);
            turn_to_screw(Screw<double>{s1[0], s1[1]}, r1(k), e1, e1, pair.h1);
            if (!group_.is_last[k] || group_.has_jointed_tip(k)) {
                Vec3 const s2 = group_.outboard_screw(k);
                turn_to_screw(Screw<double>{s2[0], s2[1]}, r2(k), e2, e2, pair.h2);
            }
        }
        return pair;
    }

  private:
    GroupView group_;
    ConstView<9> axes2_;
    ConstView<3> r2_;
    ConstView<4> rotation_;
};

/// Bodies on spherical joints in absolute coordinates: handles along ground axes, forces there too.
template <int K>
class GroundFrames {
  public:
    static constexpr bool any_forces = false, at_once = true;
    explicit GroundFrames(GroupView const& group) : r1_(group.r1), r2_(group.r2) {}
    void set(ConfigurationView const& c) { rotation_ = c.rotation; }
    CATENA_HD Vec3 r1(std::int64_t k) const { return r1_.load(k); }
    CATENA_HD Vec3 r2(std::int64_t k) const { return r2_.load(k); }
    CATENA_HD HandlePair<K> handles(std::int64_t k) const {
        Vector<double, 4> const q = rotation_.load(k);
        Mat3 const turn = to_matrix(as_quaternion(q)), to_body = transpose(turn), unit = Mat3::identity();
        return {make_handle<K>(r1(k), to_body, unit), make_handle<K>(r2(k), to_body, unit), turn};
    }

  private:
    ConstView<3> r1_, r2_;
    ConstView<4> rotation_;
};

/// Bodies and beads on links in absolute coordinates: handles along the links (full handles: and across), forces in ground axes.
template <int K>
class LinkFrames {
  public:
    static constexpr bool any_forces = false, at_once = false;
    explicit LinkFrames(GroupView const& group) : group_(group) {}
    void set(ConfigurationView const& c) {
        rotation_ = c.rotation;
        direction_ = c.direction;
        tip_direction_ = c.tip_direction;
    }
    CATENA_HD Vec3 r1(std::int64_t k) const { return group_.r1.load(k); }
    CATENA_HD Vec3 r2(std::int64_t k) const { return group_.r2.load(k); }
    CATENA_HD HandlePair<K> handles(std::int64_t k) const {
        Vector<double, 4> const q = rotation_.load(k);
        Mat3 const turn = to_matrix(as_quaternion(q));
        Mat3 const e1 = axes(direction_.load(k)), e2 = axes(outboard_direction(group_, direction_, tip_direction_, k));
        return {make_handle<K>(r1(k), transposed_times(turn, e1), e1), make_handle<K>(r2(k), transposed_times(turn, e2), e2), turn};
    }

  private:
    CATENA_HD static Mat3 axes(Vec3 const& direction) {
        if constexpr (K == 1) {
            Mat3 m = Mat3::zero();
            m.set_column(0, direction);
            return m;
        } else {
            return triple(direction);
        }
    }
    GroupView group_;
    ConstView<3> direction_, tip_direction_;
    ConstView<4> rotation_;
};

/// Rigid bodies; K = 1 links, 2 planar, 3 spherical, 4 universal, 5 revolute and sliding, 6 full.
template <int K_, class Frames>
class BodyLeaf {
  public:
    static constexpr int K = K_;
    static constexpr bool at_once = K <= 3 && Frames::at_once;
    explicit BodyLeaf(GroupView const& group) : group_(group), frames_(group) {}
    void set(ConfigurationView const& c) { frames_.set(c); }
    CATENA_HD GroupView const& group() const { return group_; }

    CATENA_HD SegmentMatrix<double, K> matrix(std::int64_t k) const {
        HandlePair<K> const h = frames_.handles(k);
        return leaf_matrix<Frames::any_forces>(group_.inverse_mass.at(k, 0), inverse_inertia(k), h.h1, h.h2);
    }
    CATENA_HD SegmentBias<double, K> bias(LoadsView const& loads, std::int64_t k) const {
        HandlePair<K> const h = frames_.handles(k);
        Vec3 a1 = group_.inverse_mass.at(k, 0) * load_or_zero(loads.force, k), a2 = a1;
        Vec3 const alpha = loads.torque.origin ? inverse_inertia(k) * applied_torque(loads, k) : Vec3::zero();
        if (loads.omega.origin) {
            Vec3 const w = loads.omega.load(k);
            a1 = a1 + h.to_force_axes * cross(w, cross(w, frames_.r1(k)));
            a2 = a2 + h.to_force_axes * cross(w, cross(w, frames_.r2(k)));
        }
        SegmentBias<double, K> b{along(h.h1, alpha, a1), along(h.h2, alpha, a2)};
        add_joint_biases(group_, loads, k, b);
        return b;
    }
    CATENA_HD void accelerate(LoadsView const& loads, std::int64_t k, Vector<double, K> const& inboard_force,
                              Vector<double, K> const& outboard_force, AccelerationsView const& out) const {
        if (!out.acceleration.origin) return;
        HandlePair<K> const h = frames_.handles(k);
        Vec3 const torque = applied_torque(loads, k) + (h.h1.torque * inboard_force - h.h2.torque * outboard_force);
        Vec3 const force = load_or_zero(loads.force, k) + (h.h1.force * inboard_force - h.h2.force * outboard_force);
        out.alpha.store(k, inverse_inertia(k) * torque);
        out.acceleration.store(k, group_.inverse_mass.at(k, 0) * force);
    }

  private:
    CATENA_HD Vec3 applied_torque(LoadsView const& loads, std::int64_t k) const {
        Vec3 const torque = load_or_zero(loads.torque, k);
        if (!loads.gyroscopic) return torque;
        Vec3 const w = loads.omega.load(k);
        return torque - cross(w, times_inverse_of(inverse_inertia(k), w));
    }
    CATENA_HD Sym3 inverse_inertia(std::int64_t k) const { return as_symmetric(group_.inverse_inertia.load(k)); }

    GroupView group_;
    Frames frames_;
};

}  // namespace catena::dca
