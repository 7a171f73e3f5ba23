// Loads and velocity biases of bodies in joint coordinates at a configuration, in any Space.
// Frames: W ground axes, B body axes, J joint frame, M meeting frame. The axes of a joint are the
// columns of LocalBodies::axes1 in M.
#pragma once

#include "dynamics/body_loads.hpp"
#include "dynamics/joint/implicit_joints.hpp"
#include "dynamics/joint/jointed_tips.hpp"
#include "joints/joint_models.hpp"
#include "kinematics/carried_beads.hpp"

namespace catena {

/// Revolute joints whose motion a solver that eliminates_revolute_joints() computes itself. They
/// are in runs of several bodies, and their body does not begin a chain. All joints of bodies side
/// by side are such (joint_lanes.cpp).
struct RevolutesInRuns {
    /// Codes of joints: 0 is no such revolute joint, `first` is that of a run's first body,
    /// `within` is any other.
    static constexpr std::uint8_t within = 1, first = 2;
    std::uint8_t const* joint = nullptr;
    /// True if joint k is such a revolute joint.
    CATENA_HD bool has(std::int64_t k) const { return joint[k] != 0; }
    /// True if body k is the first of its run.
    CATENA_HD bool begins_run(std::int64_t k) const { return joint[k] == first; }
    template <dca::SeveralBodies Place>
    CATENA_HD bool has(Place const&) const {
        return true;
    }
    /// True, because one of several bodies side by side may begin a run.
    template <dca::SeveralBodies Place>
    CATENA_HD bool begins_run(Place const&) const {
        return true;
    }
};
/// Terms that the solver computes from velocities itself. gyroscopic: the gyroscopic torque, if it
/// is the only torque (LoadsView::gyroscopic). biases: those of revolute joints
/// (LoadsView::revolute_rate). motions: those within runs (RevoluteLoads); the update computes the
/// joints' relative motions, and steps need not (joint_updates.hpp).
struct LeftToSolver {
    bool gyroscopic = false, biases = false, motions = false;
};

/// Bodies as force terms see them (ForceTerm::add_on_body()).
struct BodiesOfTerms {
    MovedBodies const& moved;
    BodyLoadsView const& given;

    template <class Place>
    CATENA_HD Vec3At<Place> omega(Place k) const {
        return moved.omega(k);
    }
    template <class Place>
    CATENA_HD Vec3At<Place> velocity(Place k) const {
        return moved.velocity(k);
    }
    template <class Place>
    CATENA_HD Vec3At<Place> r1(Place k) const {
        return moved.r1(k);
    }
    /// Numbers that a term has for body k.
    template <int D, class Place>
    CATENA_HD auto load(ConstView<D> const& field, Place k) const {
        return read(field, k);
    }
};

/// Motion, given loads and resulting loads of a group's bodies, with the operations on one body.
struct JointLoads {
    MovedBodies moved;
    RevolutesInRuns in_run;
    LeftToSolver left;
    ImplicitJoints implicit;
    BodyLoadsView given;
    int directions = 6;
    bool has_wrenches = false, has_forces = false;
    ConstView<1> mass;
    ConstView<6> inertia;
    CarriedBeadsView beads;
    // Input and output of the solver.
    /// Known load of joint k on body k: torque along the joint's axes, and force along the last
    /// axis. If the joint glides, the first two components are forces.
    View<4> joint_load;
    /// Torque and force on bodies, B.
    View<3> torque, force;
    DirectionsView bias;

    // Members below take a place k, as those of MovedBodies do.

    // Configuration.

    /// Computes the relative motion of joint k, and its known load.
    template <bool positions, class Place>
    CATENA_HD void set_relative(Place k) const {
        moved.scan.set_relative<positions>(k);
        if (given.joint_loads) set_joint_load(k);
    }
    /// Computes the motion of body k and its loads. If it carries beads, the loads have to wait for
    /// external forces on these; `keeps_forces` keeps the forces of before.
    template <bool positions, class Place>
    CATENA_HD void set_motion(Place k, bool keeps_forces) const {
        moved.scan.set_motion<positions>(k);
        if constexpr (is_one_body<Place>)
            if (beads && !keeps_forces) {
                Mat3 const axes = moved.orientation(k);
                beads.put(k, moved.scan.motion.origin.load(k) - axes * moved.r1(k), axes);
                return beads.clear_forces(k);
            }
        set_loads(k);
    }

    // Loads.

    /// Sets the load of joint k along its free directions: given torque, spring and damper.
    template <class Place>
    CATENA_HD void set_joint_load(Place k) const {
        using Real = RealAt<Place>;
        if (moved.drive_of(k)) return write(joint_load, k, Vector<Real, 4>::zero());
        Vec3At<Place> qd = read(moved.scan.state.qd, k);
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) qd = implicit.start.load(k);
        Vec3At<Place> const along =
            LoadedJoint<Place>{given, k, moved.joints().type(k), read(moved.scan.state.q, k), qd}
                .along();
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) {
                implicit.set(moved, given, k, along);
                return joint_load.store(k, Vector<double, 4>::zero());
            }
        write(joint_load, k, load_along_axes(k, along));
    }
    /// Torque about the axis of a revolute joint that has no prescribed motion and is not implicit.
    CATENA_HD double torque_about_revolute(std::int64_t k) const {
        return LoadedAxis{given, k, moved.scan.state.q, moved.scan.state.qd}.along();
    }
    /// Load on the outboard body from the moments along the coordinates, see joint_load. In a
    /// universal joint the torque lies in the plane of its two axes.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> load_along_axes(Place k, Vec3At<Place> const& along) const {
        return with_motion(moved.joints().type(k), [&](auto motion) {
            return motion.load(moved.joint_at(k), [&] { return moved.rotation(k); }, along);
        });
    }
    /// Torque of a known load in the axes of the columns of `e`; `across`: the joint glides.
    template <class Real>
    CATENA_HD static Vector<Real, 3> torque_of(Matrix<Real, 3, 3> const& e,
                                               Vector<Real, 4> const& load, bool across) {
        Real const none(0);
        return e * (across ? Vector<Real, 3>{{none, none, load[2]}}
                           : Vector<Real, 3>{{load[0], load[1], load[2]}});
    }
    /// Counterpart of torque_of() for the force.
    template <class Real>
    CATENA_HD static Vector<Real, 3> force_of(Matrix<Real, 3, 3> const& e,
                                              Vector<Real, 4> const& load, bool across) {
        Vector<Real, 3> const along = load[3] * e.column(2);
        return across ? along + (load[0] * e.column(0) + load[1] * e.column(1)) : along;
    }
    /// Adds the known loads of the joints at both ends of body k, along their free directions, to
    /// its moment and force, B.
    template <class Place>
    CATENA_HD void add_joint_loads(Place k, Mat3At<Place> const& inboard_turn,
                                   Vec3At<Place>& moment, Vec3At<Place>& push) const {
        using Vector3 = Vec3At<Place>;
        auto const in = read(joint_load, k);
        auto const e1 = transposed_times(inboard_turn, moved.joints().axes(k));
        bool const across1 = moved.joints().glides(k);
        moment = moment + torque_of(e1, in, across1);
        if (moved.joints().has_screws) {
            Vector3 const f = force_of(e1, in, across1);
            push = push + f;
            moment = moment + cross(moved.r1(k), f);
        }
        if constexpr (is_one_body<Place>)
            if (moved.joints().inboard) {
                JointsView const& joints = moved.joints();
                for (std::int64_t c = joints.first_child[k]; c < joints.first_child[k + 1]; ++c)
                    add_reaction(joints.child[c], joints.child[c], moment, push);
                return;
            }
        if (!moved.joints().ends_chain(k)) add_reaction(k, k + 1, moment, push);
    }
    /// Adds the reaction to the known load of a joint to the moment and force on its inboard body.
    /// `handle_of`: place of that body's handle.
    template <class Place>
    CATENA_HD void add_reaction(Place handle_of, Place joint, Vec3At<Place>& moment,
                                Vec3At<Place>& push) const {
        auto const out = read(joint_load, joint);
        auto const e2 = moved.axes2(handle_of);
        bool const across2 = moved.joints().glides(joint);
        moment = moment - torque_of(e2, out, across2);
        if (moved.joints().has_screws) {
            auto const f = force_of(e2, out, across2);
            push = push - f;
            moment = moment - cross(moved.r2(handle_of), f);
        }
    }
    /// Wrench on body k from outside the chain and from carried beads, W.
    CATENA_HD Wrench wrench(std::int64_t k) const {
        Wrench w =
            beads ? beads.on_body(k, moved.orientation(k)) : Wrench{Vec3::zero(), Vec3::zero()};
        if (given.wrenches)
            w = {w.torque + given.wrench_torque.load(k), w.force + given.wrench_force.load(k)};
        return w;
    }
    template <class Place>
    CATENA_HD WrenchOf<RealAt<Place>> wrench(Place const& several) const {
        return {read(given.wrench_torque, several), read(given.wrench_force, several)};
    }
    /// Gyroscopic torque omega x J omega, B.
    template <class Place>
    CATENA_HD Vec3At<Place> gyroscopic_torque(Place k) const {
        return cross(moved.omega(k), as_symmetric(read(inertia, k)) * moved.omega(k));
    }

    /// Sets torque, force and bias of body k, unless they are left to the solver.
    template <class Place>
    CATENA_HD void set_loads(Place k) const {
        set_torque(k);
        set_biases(k);
    }
    template <class Place>
    CATENA_HD void set_torque(Place k) const {
        if (!left.gyroscopic) set_wrench(k);
    }
    template <class Place>
    CATENA_HD void set_biases(Place k) const {
        if (!left.biases || !in_run.has(k)) set_bias(k, moved.rotation(k), moved.joints().axes(k));
    }
    /// Adds the terms' forces that act on body k in its own axes.
    template <class Place, class... Terms>
    CATENA_HD void add_terms(Place k, Vec3At<Place>& moment, Vec3At<Place>& push,
                             TypeList<Terms...>) const {
        (Terms::add_on_body(BodiesOfTerms{moved, given}, k, moment, push), ...);
    }
    /// Sets the total torque and force on body k, except joint constraint forces.
    template <class Place>
    CATENA_HD void set_wrench(Place k) const {
        using Vector3 = Vec3At<Place>;
        // The gyroscopic torque of a planar chain is perpendicular to its axis and has no effect on
        // the motion. It may be large, so that its rounding would have one.
        Vector3 moment = moved.joints().planar ? Vector3::zero() : -gyroscopic_torque(k),
                push = Vector3::zero();
        if (given.joint_loads) add_joint_loads(k, moved.rotation(k), moment, push);
        if (has_wrenches) {
            auto const outside = wrench(k);
            auto const axes = moved.orientation(k);
            moment = moment + transposed_times(axes, outside.torque);
            push = push + transposed_times(axes, outside.force);
        }
        add_terms(k, moment, push, terms::ForceTerms{});
        write(torque, k, moment);
        // Motion across the plane is impossible.
        if (moved.joints().planar && has_forces) {
            Vector3 const axis = moved.joints().axes(k).column(2);
            push = plus_scaled(push, -dot(axis, push), axis);
        }
        if (has_forces) write(force, k, push);
    }
    /// Sets the bias of joint k along the directions of its handles.
    template <class Place>
    CATENA_HD void set_bias(Place k, Mat3At<Place> const& to_meeting,
                            Mat3At<Place> const& axes1) const {
        using Vector3 = Vec3At<Place>;
        // Velocity terms -c along the joint's axes.
        Vector3 linear = Vector3::zero(), angular = Vector3::zero();
        JointType const type = moved.joints().type(k);
        bool const any_axis = is_ball(type) && !implicit.has(k);
        if (!floats(type) && !any_axis && !is_rigid(type) && !moved.joints().planar) {
            angular = -transposed_times(axes1, moved.velocity_term(k, linear));
            linear = -transposed_times(axes1, linear);
        }
        // The ground accelerates by -g.
        if constexpr (is_one_body<Place>)
            if (moved.joints().is_first[k] && !floats(type))
                linear = linear +
                         transposed_times(axes1, to_meeting * transposed_times(moved.orientation(k),
                                                                               given.gravity));
        Vector<RealAt<Place>, 6> b = dca::along_directions(
            moved.joints().direction_of_screw(k), dca::AlongAxes<RealAt<Place>>{linear, angular});
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) add_yielding(b, -implicit.yielding.load(k));
        store_first(bias, k, directions, b);
    }
};

}  // namespace catena
