// Leaves of the tree: each reads one body from the arrays and computes its matrices, its bias and,
// when the joint forces are known, its acceleration. B stands for body axes, W for ground axes.
#pragma once

#include "dca/floating_run.hpp"
#include "dca/lane_access.hpp"

namespace catena::dca {

/// Returns the value at `k`, or zero for a view without origin.
template <int D, class Place>
CATENA_HD Vector<RealAt<Place>, D> read_or_zero(ConstView<D> const& view, Place k) {
    return ReadHere{}.if_any(view, k);
}

/// Returns the unit direction of the link on the outboard side of body k; 0 if there is none.
template <class Place>
CATENA_HD Vector<RealAt<Place>, 3> outboard_direction(GroupView const& group,
                                                      ConstView<3> direction,
                                                      ConstView<3> tip_direction, Place k) {
    if (!ends_chain(group, k)) return read(direction, k + 1);
    return has_jointed_tip(group, k) ? read(tip_direction, k) : Vector<RealAt<Place>, 3>::zero();
}

/// Adds the velocity terms of body k's inboard joint and of a jointed tip. The tip's term has the
/// opposite sign, because the body is on the inboard side of the tip's joint.
template <int K, class Place>
CATENA_HD void add_joint_biases(GroupView const& group, LoadsView const& loads, Place k,
                                SegmentBias<RealAt<Place>, K>& b) {
    if (loads.bias) b.b1 = b.b1 + read_directions<K>(loads.bias, k);
    if (loads.tip_bias && has_jointed_tip(group, k))
        b.b2 = b.b2 - read_directions<K>(loads.tip_bias, k);
}

/// Writes the forces at body k's two joints, if they are requested.
template <int K, class Place>
CATENA_HD void store_forces(GroupView const& group, AccelerationsView const& out, Place k,
                            Vector<RealAt<Place>, K> const& inboard,
                            Vector<RealAt<Place>, K> const& outboard) {
    if (out.joint_force) write_directions<K>(out.joint_force, k, inboard);
    if (out.tip_force && has_jointed_tip(group, k)) write_directions<K>(out.tip_force, k, outboard);
}

/// Leaf of point beads. K = 1: projected handles, 3: full handles.
template <int K_>
class BeadLeaf {
  public:
    // Properties of a leaf. `beads`: it has point beads. `in_joints`: it uses joint coordinates.
    // `projected`: its handles carry fewer directions than full ones. `reads_neighbours` and
    // `by_inertia` are explained in BodyLeaf.
    static constexpr int K = K_;
    static constexpr bool beads = true, in_joints = false, projected = K == 1,
                          reads_neighbours = true, by_inertia = false;
    /// Leaf that reads positions and velocities instead of link directions, for the fused sweep.
    using Moving = BeadLeafFromPositions<K>;
    explicit BeadLeaf(GroupView const& group) : group_(group) {}
    void set(ConfigurationView const& c) {
        direction_ = c.direction;
        tip_direction_ = c.tip_direction;
    }
    CATENA_HD GroupView const& group() const { return group_; }

    /// Returns the matrices of bead k along the directions of its links.
    template <class Place>
    CATENA_HD SegmentMatrix<RealAt<Place>, K> matrix(Place k) const {
        return bead_matrix(inverse_mass(k), read(direction_, k), outboard(k),
                           Vector<RealAt<Place>, K>{});
    }
    /// Returns the bias of bead k along the directions of its links.
    template <class Place>
    CATENA_HD SegmentBias<RealAt<Place>, K> bias(LoadsView const& loads, Place k) const {
        using Real = RealAt<Place>;
        auto b = SegmentBias<Real, K>::zero();
        if (loads.force.origin)
            b = bead_bias(inverse_mass(k), read(loads.force, k), read(direction_, k), outboard(k),
                          Vector<RealAt<Place>, K>{});
        add_joint_biases(group_, loads, k, b);
        return b;
    }
    /// Writes the acceleration of bead k from the forces at its two links, if it is requested.
    template <class Place>
    CATENA_HD void accelerate(LoadsView const& loads, Place k,
                              Vector<RealAt<Place>, K> const& inboard_force,
                              Vector<RealAt<Place>, K> const& outboard_force,
                              AccelerationsView const& out) const {
        if (!out.acceleration.origin) return;
        write(out.acceleration, k,
              bead_acceleration(inverse_mass(k), read_or_zero(loads.force, k), inboard_force[0],
                                read(direction_, k), outboard_force[0], outboard(k)));
    }

  private:
    template <class Place>
    CATENA_HD RealAt<Place> inverse_mass(Place k) const {
        return read(group_.inverse_mass, k)[0];
    }
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 3> outboard(Place k) const {
        return outboard_direction(group_, direction_, tip_direction_, k);
    }
    GroupView group_;
    ConstView<3> direction_, tip_direction_;
};

/// The two handles of a body whose forces are kept in its own axes (B).
template <class Handle>
struct HandlePair {
    Handle h1, h2;
    template <class Real>
    CATENA_HD static Vector<Real, 3> in_force_axes(Vector<Real, 3> const& v) {
        return v;
    }
};
/// The two handles of a body whose forces are kept in other axes, and the rotation matrix from B to
/// these.
template <class Handle, class Real>
struct TurnedHandlePair {
    Handle h1, h2;
    Matrix<Real, 3, 3> to_force_axes;
    CATENA_HD Vector<Real, 3> in_force_axes(Vector<Real, 3> const& v) const {
        return to_force_axes * v;
    }
};

/// Adds the compliance of the inboard joint to the body's handle (src/dca/README.md, "Joints"): Z +
/// P B^-1 P^T. The directions that a joint leaves free are among the last three of full handles.
template <int K, class Place>
CATENA_HD void add_compliance(ConstView<6> const& compliance, Place k,
                              SegmentMatrix<RealAt<Place>, K>& s) {
    if constexpr (K == 6)
        if (compliance.origin) {
            auto const c = as_symmetric(read(compliance, k));
            CATENA_UNROLL
            for (int i = 0; i < 3; ++i) {
                CATENA_UNROLL
                for (int j = 0; j <= i; ++j) s.z11(3 + i, 3 + j) = s.z11(3 + i, 3 + j) + c(i, j);
            }
        }
}

/// Handles of bodies in joint coordinates: along the axes of the meeting frames, with forces in B.
/// `sliding`: some joint translates.
template <int K, bool sliding>
class JointFrameHandles {
  public:
    // Properties of handles. `any_forces`: directions may combine forces and torques. `in_joints`:
    // joint coordinates. `on_links`: handles along links.
    static constexpr bool any_forces = sliding, in_joints = true, on_links = false;
    explicit JointFrameHandles(GroupView const& group)
        : group_(group), axes2_(group.axes2), r2_(group.r2) {}
    void set(ConfigurationView const& c) {
        rotation_ = c.rotation;
        compliance_ = c.compliance;
        if (c.axes2.origin) axes2_ = c.axes2;
        if (c.r2.origin) r2_ = c.r2;
    }
    // Data from which a body's handles are computed: r1 and r2 from the centre of mass (B), the
    // rotation (w x y z), and two axes of each meeting frame.
    template <class Real>
    struct State {
        Vector<Real, 3> r1, r2;
        Vector<Real, 4> rotation;
        Vector<Real, 6> axes1, axes2;
    };
    template <class Place, class Reader = ReadHere>
    CATENA_HD State<RealAt<Place>> state(Place k, Reader&& by = {}) const {
        return {by(group_.r1, k), by(r2_, k), by(rotation_, k), by(group_.axes1, k), by(axes2_, k)};
    }
    template <class Place, class Reader>
    CATENA_HD Vector<RealAt<Place>, 4> rotation(Place k, Reader&& by) const {
        return by(rotation_, k);
    }
    template <class Place, class Reader>
    CATENA_HD Vector<RealAt<Place>, 3> r2(Place k, Reader&& by) const {
        return by(r2_, k);
    }
    /// Returns the axes of the inboard handle in B. `rotation` is the matrix of the body's
    /// rotation.
    template <class Real>
    CATENA_HD static Matrix<Real, 3, 3> inboard_axes(State<Real> const& state,
                                                     Matrix<Real, 3, 3> const& rotation) {
        return transposed_times(rotation, axes_of(state.axes1));
    }
    /// Returns the two handles of body k. `rotation` is the matrix of the body's rotation.
    template <class Place>
    CATENA_HD HandlePair<Handle<RealAt<Place>, K, sliding>> handles(
        State<RealAt<Place>> const& state, Place k, Mat3At<Place> const& rotation) const {
        using Real = RealAt<Place>;
        auto const e1 = inboard_axes(state, rotation), e2 = axes_of(state.axes2);
        HandlePair<Handle<Real, K, sliding>> pair{make_handle<K, sliding>(state.r1, e1, e1),
                                                  make_handle<K, sliding>(state.r2, e2, e2)};
        if constexpr (sliding) {
            turn_to_screw(as_screw(read(group_.screw, k)), state.r1, e1, e1, pair.h1);
            if (!ends_chain(group_, k) || has_jointed_tip(group_, k))
                turn_to_screw(as_screw(outboard_screw(group_, k)), state.r2, e2, e2, pair.h2);
        }
        return pair;
    }
    /// Adds the compliance of body k's inboard joint to its segment.
    template <class Place>
    CATENA_HD void add_joint_compliance(Place k, SegmentMatrix<RealAt<Place>, K>& s) const {
        add_compliance(compliance_, k, s);
    }

  private:
    GroupView group_;
    ConstView<6> compliance_;
    ConstView<6> axes2_;
    ConstView<3> r2_;
    ConstView<4> rotation_;
};

/// Handles of bodies on spherical joints in absolute coordinates: along ground axes, with forces in
/// W.
template <int K>
class GroundFrames {
  public:
    static constexpr bool any_forces = false, in_joints = false, on_links = false;
    explicit GroundFrames(GroupView const& group) : r1_(group.r1), r2_(group.r2) {}
    void set(ConfigurationView const& c) {
        rotation_ = c.rotation;
        compliance_ = c.compliance;
    }
    /// Adds the compliance of body k's inboard joint to its segment.
    template <class Place>
    CATENA_HD void add_joint_compliance(Place k, SegmentMatrix<RealAt<Place>, K>& s) const {
        add_compliance(compliance_, k, s);
    }
    // Data of one body that its handles are computed from: r1 and r2 from the centre of mass (B),
    // and the rotation (w x y z).
    template <class Real>
    struct State {
        Vector<Real, 3> r1, r2;
        Vector<Real, 4> rotation;
    };
    template <class Place, class Reader = ReadHere>
    CATENA_HD State<RealAt<Place>> state(Place k, Reader&& by = {}) const {
        return {by(r1_, k), by(r2_, k), by(rotation_, k)};
    }
    template <class Place>
    CATENA_HD TurnedHandlePair<GroundHandle<RealAt<Place>, K>, RealAt<Place>> handles(
        State<RealAt<Place>> const& state, Place /*k*/, Mat3At<Place> const& rotation) const {
        Mat3At<Place> const to_body = transpose(rotation);
        return {make_ground_handle<K>(state.r1, to_body), make_ground_handle<K>(state.r2, to_body),
                rotation};
    }

  private:
    ConstView<3> r1_, r2_;
    ConstView<4> rotation_;
    ConstView<6> compliance_;
};

/// Handles of bodies and beads on links in absolute coordinates: along the links, with forces in W.
/// Full handles have directions across the links too.
template <int K>
class LinkFrames {
  public:
    static constexpr bool any_forces = false, in_joints = false, on_links = true;
    explicit LinkFrames(GroupView const& group) : group_(group) {}
    void set(ConfigurationView const& c) {
        rotation_ = c.rotation;
        direction_ = c.direction;
        tip_direction_ = c.tip_direction;
    }
    template <class Real>
    struct State {
        // Handles from the centre of mass (B), and unit directions of the two links (W).
        Vector<Real, 3> r1, r2, inboard, outboard;
        Vector<Real, 4> rotation;
    };
    template <class Place, class Reader = ReadHere>
    CATENA_HD State<RealAt<Place>> state(Place k, Reader&& by = {}) const {
        return {by(group_.r1, k), by(group_.r2, k), read(direction_, k),
                outboard_direction(group_, direction_, tip_direction_, k), by(rotation_, k)};
    }
    template <class Place>
    CATENA_HD TurnedHandlePair<Handle<RealAt<Place>, K>, RealAt<Place>> handles(
        State<RealAt<Place>> const& state, Place /*k*/, Mat3At<Place> const& rotation) const {
        Mat3At<Place> const e1 = axes(state.inboard), e2 = axes(state.outboard);
        return {make_handle<K>(state.r1, transposed_times(rotation, e1), e1),
                make_handle<K>(state.r2, transposed_times(rotation, e2), e2), rotation};
    }

  private:
    // Axes of a handle whose first direction is that of the link.
    template <class Real>
    CATENA_HD static Matrix<Real, 3, 3> axes(Vector<Real, 3> const& direction) {
        if constexpr (K == 1) {
            auto m = Matrix<Real, 3, 3>::zero();
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

/// Leaf of rigid bodies. K = 1: links, 2: planar, 3: spherical, 4: universal, 5: revolute joints
/// and those that translate, 6: full handles.
template <int K_, class Frames_>
class BodyLeaf {
  public:
    static constexpr int K = K_;
    using Frames = Frames_;
    static constexpr bool beads = false, in_joints = Frames::in_joints,
                          projected = Frames::on_links ? K == 1 : K < 6;
    // True if the leaf reads bodies other than its own, or must find out whether there are any.
    static constexpr bool reads_neighbours = Frames::on_links || Frames::any_forces;
    /// True if runs of bodies on revolute joints alone are computed by articulated-body inertias
    /// (floating_run.hpp).
    static constexpr bool by_inertia = K == 5 && in_joints && !Frames::any_forces;
    explicit BodyLeaf(GroupView const& group) : group_(group), frames_(group) {}
    void set(ConfigurationView const& c) { frames_.set(c); }
    CATENA_HD GroupView const& group() const { return group_; }

    /// All data that are read of one body. They are read first, so that no read waits for a result
    /// of other data.
    template <class Place>
    struct Body {
        using Real = RealAt<Place>;
        Place k;
        Real inverse_mass;
        Symmetric<Real, 3> inverse_inertia;
        typename Frames::template State<Real> state;
        Vector<Real, 3> force, torque, omega;
    };
    template <class Place, class Reader = ReadHere>
    CATENA_HD Body<Place> body(LoadsView const& loads, Place k, Reader&& by = {}) const {
        return {k,
                by(group_.inverse_mass, k)[0],
                as_symmetric(by(group_.inverse_inertia, k)),
                frames_.state(k, by),
                by.if_any(loads.force, k),
                by.once_if_any(loads.torque, k),
                by.once_if_any(loads.omega, k)};
    }
    /// Results that the segment and the accelerations of a body both need. Computing them again
    /// takes longer than storing them.
    template <class Place>
    struct Turning {
        RealAt<Place> scale;   // Value of matrix_scale() of the body's rotation.
        Vec3At<Place> torque;  // Torque on the body in B, gyroscopic torque included.
    };
    /// `Turning` with the rotation expanded to a matrix.
    template <class Place>
    struct Turned {
        Mat3At<Place> rotation;  // Matrix of the body's rotation, to_matrix().
        Vec3At<Place> torque;
    };
    /// Computes what the segment and the accelerations of a body both need.
    template <class Place, class Factorizer = dca::Factorizer>
    CATENA_HD Turning<Place> turning(LoadsView const& loads, Body<Place> const& body,
                                     Factorizer const& factors = {}) const {
        return factors.with_inverse([&](auto const& inverse) {
            return Turning<Place>{matrix_scale(as_quaternion(body.state.rotation), inverse),
                                  applied_torque(loads, body, inverse)};
        });
    }
    template <class Place>
    CATENA_HD static Turned<Place> turned(Body<Place> const& body, Turning<Place> const& t) {
        return {to_matrix(as_quaternion(body.state.rotation), t.scale), t.torque};
    }
    template <class Place>
    CATENA_HD Turned<Place> turned(LoadsView const& loads, Body<Place> const& body) const {
        return turned(body, turning(loads, body));
    }
    /// Returns the segment of a body, its matrices and its bias.
    template <class Place>
    CATENA_HD BiasedSegment<RealAt<Place>, K> segment(LoadsView const& loads,
                                                      Body<Place> const& body,
                                                      Turned<Place> const& t) const {
        auto const h = frames_.handles(body.state, body.k, t.rotation);
        return {matrix(body, h), bias(loads, body, t, h)};
    }
    CATENA_HD SegmentMatrix<double, K> matrix(std::int64_t k) const {
        auto const at_k = body(LoadsView{}, k);
        return matrix(
            at_k, frames_.handles(at_k.state, k, to_matrix(as_quaternion(at_k.state.rotation))));
    }
    CATENA_HD SegmentBias<double, K> bias(LoadsView const& loads, std::int64_t k) const {
        auto const at_k = body(loads, k);
        auto const t = turned(loads, at_k);
        return bias(loads, at_k, t, frames_.handles(at_k.state, k, t.rotation));
    }
    /// Writes the acceleration of body k from the forces at its two joints, if it is requested.
    template <class Place>
    CATENA_HD void accelerate(LoadsView const& loads, Place k,
                              Vector<RealAt<Place>, K> const& inboard_force,
                              Vector<RealAt<Place>, K> const& outboard_force,
                              AccelerationsView const& out) const {
        if (!out.acceleration.origin) return;
        auto const at_k = body(loads, k);
        accelerate(at_k, turned(loads, at_k), inboard_force, outboard_force, out);
    }
    /// Writes the acceleration of a body whose data were read before. Precondition: accelerations
    /// are requested.
    template <class Place>
    CATENA_HD void accelerate(Body<Place> const& at_k, Turned<Place> const& t,
                              Vector<RealAt<Place>, K> const& inboard_force,
                              Vector<RealAt<Place>, K> const& outboard_force,
                              AccelerationsView const& out) const {
        Place const k = at_k.k;
        auto const h = frames_.handles(at_k.state, k, t.rotation);
        auto const torque = t.torque + (moment(h.h1, inboard_force) - moment(h.h2, outboard_force));
        auto const force = at_k.force + (push(h.h1, inboard_force) - push(h.h2, outboard_force));
        write(out.alpha, k, at_k.inverse_inertia * torque);
        write(out.acceleration, k, at_k.inverse_mass * force);
    }

    /// Returns the kinematics of body k for floating_run.hpp. Precondition of this and the
    /// following functions: `by_inertia`.
    template <class Place>
    CATENA_HD RevoluteFrame<RealAt<Place>> revolute_frame(LoadsView const& loads, Place k) const {
        auto f = frame_at_rest(k);
        set_moving(loads, k, read_or_zero(loads.omega, k), f);
        return f;
    }
    /// Returns body k with its inertia and its loads for floating_run.hpp.
    template <class Place>
    CATENA_HD ArticulatedBody<RealAt<Place>> revolute(LoadsView const& loads, Place k) const {
        auto b = revolute_at_rest(loads, k);
        auto const omega = read_or_zero(loads.omega, k);
        set_moving(loads, k, omega, b);
        add_gyroscopic(loads, omega, b);
        return b;
    }
    /// Returns body k for run_kinematics.hpp. Precondition: `loads.revolutes` and
    /// `loads.revolute_rate` are given.
    template <class Place, class Reader = ReadHere>
    CATENA_HD BodyOnRevolute<RealAt<Place>> on_revolute(LoadsView const& loads, Place k,
                                                        Reader&& by = {}) const {
        return {rotation_on_revolute(loads, k, by),
                by(group_.axes1.template components<3>(3), k),
                by(group_.r1, k),
                frames_.r2(k, by),
                by(loads.revolute_rate, k)[0],
                by(group_.mass, k)[0],
                as_symmetric(by(group_.inertia, k))};
    }
    /// Returns two axes of the meeting frame on body k's outboard side, in B.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 6> axes2(Place k) const {
        return frames_.state(k).axes2;
    }
    // The parts of these results. They are filled in place: a compiler may copy vectors by halves,
    // and the next read of the whole vector then waits for both halves.
    /// Returns the kinematics of body k without its velocity terms.
    template <class Place>
    CATENA_HD RevoluteFrame<RealAt<Place>> frame_at_rest(Place k) const {
        using Vector3 = Vec3At<Place>;
        auto const state = frames_.state(k);
        return {state.r1,
                state.r2,
                Frames::inboard_axes(state, to_matrix(as_quaternion(state.rotation))),
                axes_of(state.axes2),
                Vector3::zero(),
                Vector3::zero(),
                Vector<RealAt<Place>, 5>::zero()};
    }
    /// Returns body k without velocity terms and gyroscopic torque.
    template <class Place>
    CATENA_HD ArticulatedBody<RealAt<Place>> revolute_at_rest(LoadsView const& loads,
                                                              Place k) const {
        return {frame_at_rest(k), read(group_.mass, k)[0], as_symmetric(read(group_.inertia, k)),
                read_or_zero(loads.torque, k), read_or_zero(loads.force, k)};
    }
    /// Sets the velocity terms of body k from its angular velocity `omega` (B).
    template <class Place>
    CATENA_HD void set_moving(LoadsView const& loads, Place k, Vec3At<Place> const& omega,
                              RevoluteFrame<RealAt<Place>>& f) const {
        f.inward1 = cross(omega, cross(omega, f.r1));
        f.inward2 = cross(omega, cross(omega, f.r2));
        if (loads.revolute_rate.origin) {
            f.bias = revolute_bias(f.e1, omega, read(loads.revolute_rate, k)[0]);
            if (!begins_chain(group_, k)) return;
        }
        if (loads.bias) f.bias = read_directions<5>(loads.bias, k);
    }
    /// Adds the gyroscopic torque -omega x J omega, unless the loads contain it.
    template <class Real>
    CATENA_HD void add_gyroscopic(LoadsView const& loads, Vector<Real, 3> const& omega,
                                  ArticulatedBody<Real>& b) const {
        if (loads.gyroscopic) b.torque = b.torque - cross(omega, b.inertia * omega);
    }

  private:
    template <class Place, class Handles>
    CATENA_HD SegmentMatrix<RealAt<Place>, K> matrix(Body<Place> const& body,
                                                     Handles const& h) const {
        auto s = leaf_matrix(body.inverse_mass, body.inverse_inertia, h.h1, h.h2);
        if constexpr (!Frames::on_links) frames_.add_joint_compliance(body.k, s);
        return s;
    }
    template <class Place, class Handles>
    CATENA_HD SegmentBias<RealAt<Place>, K> bias(LoadsView const& loads, Body<Place> const& body,
                                                 Turned<Place> const& t, Handles const& h) const {
        using Real = RealAt<Place>;
        Vector<Real, 3> a1 = body.inverse_mass * body.force, a2 = a1;
        Vector<Real, 3> const alpha = loads.torque.origin || loads.gyroscopic
                                          ? body.inverse_inertia * t.torque
                                          : Vector<Real, 3>::zero();
        if (loads.omega.origin) {
            Vector<Real, 3> const& w = body.omega;
            a1 = a1 + h.in_force_axes(cross(w, cross(w, body.state.r1)));
            a2 = a2 + h.in_force_axes(cross(w, cross(w, body.state.r2)));
        }
        SegmentBias<Real, K> b{along(h.h1, alpha, a1), along(h.h2, alpha, a2)};
        add_joint_biases(group_, loads, body.k, b);
        return b;
    }
    /// Returns the torque on a body in B, gyroscopic torque included. The inertia is recovered from
    /// its inverse unless it is stored (`by_inertia`).
    template <class Place, class Inverse>
    CATENA_HD Vector<RealAt<Place>, 3> applied_torque(LoadsView const& loads,
                                                      Body<Place> const& body,
                                                      Inverse const& inverse) const {
        if (!loads.gyroscopic) return body.torque;
        if constexpr (by_inertia)
            return body.torque -
                   cross(body.omega, as_symmetric(read(group_.inertia, body.k)) * body.omega);
        return body.torque -
               cross(body.omega, times_inverse_of(body.inverse_inertia, body.omega, inverse));
    }

    /// Returns the rotation of body k to the axes of the body before.
    template <class Reader>
    CATENA_HD static Quat rotation_on_revolute(LoadsView const& loads, std::int64_t k,
                                               Reader&& by) {
        return as_quaternion(by(loads.revolutes.rotation, k));
    }
    template <SeveralBodies Place, class Reader>
    CATENA_HD QuatAt<Place> rotation_on_revolute(LoadsView const& loads, Place const& several,
                                                 Reader&& by) const {
        return as_quaternion(by(loads.revolutes.frame, several)) *
               as_quaternion(frames_.rotation(several, by));
    }

    GroupView group_;
    Frames frames_;
};

}  // namespace catena::dca
