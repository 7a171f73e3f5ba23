// Loads and velocity biases of bodies in joint coordinates at a configuration, in any Space.
// Frames: W ground axes, B body axes, J joint frame, M meeting frame. The axes of a joint are the
// columns of LocalBodies::axes1 in M.
#pragma once

#include "dynamics/body_loads.hpp"
#include "dynamics/joint/jointed_tips.hpp"
#include "joints/joint_models.hpp"
#include "kinematics/carried_beads.hpp"
#include "kinematics/joint_scan.hpp"
#include "math/philox.hpp"

namespace catena {

/// Springs K and dampers C that act implicitly within a step of length h. With B = c h^2 K + h C /
/// 2 (c: rotor_of_spring()), the joint obeys P^T phi = tau - B u'. The joint's force then is
/// unknown along every direction, and its two sides accelerate relative to each other by u' = B^-1
/// (tau - P^T phi).
struct ImplicitJoints {
    /// B / K = c h^2, and B / C = h / 2.
    double of_stiffness = 0, of_damping = 0;
    /// True for joint k if it is implicit; null if no joint is.
    std::uint8_t const* joint = nullptr;
    /// Compliance P B^-1 P^T along the last three directions of the joint's handles.
    View<6> compliance;
    /// Acceleration P B^-1 tau, along the same directions.
    View<3> yielding;
    /// Velocities at the step's start, on which dampers act; B covers what the step adds to them.
    View<3> start;

    /// True if joint k is implicit.
    CATENA_HD bool has(std::int64_t k) const { return joint && joint[k] != 0; }
    /// False for several bodies side by side, because implicit joints are never placed there.
    template <dca::SeveralBodies Place>
    CATENA_HD bool has(Place const&) const {
        return false;
    }
};

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

/// Motion, given loads and resulting loads of a group's bodies, with the operations on one body.
struct JointLoads {
    JointScan scan;
    RevolutesInRuns in_run;
    LeftToSolver left;
    ImplicitJoints implicit;
    BodyLoadsView given;
    double time = 0;
    int directions = 6;
    bool has_wrenches = false, has_forces = false;
    ConstView<1> mass;
    ConstView<6> inertia;
    ConstView<3> fixed_r2;
    ConstView<6> fixed_axes2;
    CarriedBeadsView beads;
    // Input and output of the solver.
    /// Known load of joint k on body k: torque along the joint's axes, and force along the last
    /// axis. If the joint glides, the first two components are forces.
    View<4> joint_load;
    /// Torque and force on bodies and their accelerations, B. The accelerations are relative to a
    /// frame that falls with gravity.
    View<3> torque, force, alpha, acceleration;
    DirectionsView bias;
    /// Value of outboard_end_of() by body. Entry -1 is that of the body before this rank's first
    /// one.
    View<4> outboard_end;

    CATENA_HD JointsView const& joints() const { return scan.joints; }
    /// Inboard joint of the bodies at a place, for the motions of joints.
    template <class Place>
    CATENA_HD JointAt<Place> joint_at(Place k) const {
        return {scan.joints, scan.state, k};
    }
    // Members below take a place k: one body, or several consecutive bodies side by side
    // (dca/lane_access.hpp, JointsView::type).
    /// Rotation of B in M.
    template <class Place>
    CATENA_HD Mat3At<Place> rotation(Place k) const {
        return to_matrix(as_quaternion(read(scan.motion.joint_turn, k)));
    }
    /// Rotation of B in W.
    template <class Place>
    CATENA_HD Mat3At<Place> orientation(Place k) const {
        return to_matrix(as_quaternion(read(scan.motion.orientation, k)));
    }
    /// Angular velocity of body k, B.
    template <class Place>
    CATENA_HD Vec3At<Place> omega(Place k) const {
        return read(scan.motion.omega, k);
    }
    /// Velocity of the inboard end of body k, B.
    template <class Place>
    CATENA_HD Vec3At<Place> velocity(Place k) const {
        return read(scan.motion.velocity, k);
    }
    /// Numbers that a force term has for body k.
    template <int D, class Place>
    CATENA_HD auto load(ConstView<D> const& field, Place k) const {
        return read(field, k);
    }
    /// Handle 1 of body k from its centre of mass, B.
    template <class Place>
    CATENA_HD Vec3At<Place> r1(Place k) const {
        return read(joints().r1, k);
    }
    /// Axes of the outboard joint of body k, B.
    template <class Place>
    CATENA_HD Mat3At<Place> axes2(Place k) const {
        return axes_of(scan.motion.axes2.origin ? read(scan.motion.axes2, k)
                                                : read(fixed_axes2, k));
    }
    /// Handle 2 of body k from its centre of mass, B.
    template <class Place>
    CATENA_HD Vec3At<Place> r2(Place k) const {
        return scan.motion.r2.origin ? read(scan.motion.r2, k) : read(fixed_r2, k);
    }
    /// Prescribed motion of joint k; null if it has none. Joints of several bodies side by side
    /// have none.
    CATENA_HD LocalDrive const* drive_of(std::int64_t k) const {
        return joints().drives > 0 ? joints().drive_of(k) : nullptr;
    }
    template <dca::SeveralBodies Place>
    CATENA_HD LocalDrive const* drive_of(Place const&) const {
        return nullptr;
    }

    // Configuration.

    /// Computes the relative motion of joint k, and its known load.
    template <bool positions, class Place>
    CATENA_HD void set_relative(Place k) const {
        scan.set_relative<positions>(k);
        if (given.joint_loads) set_joint_load(k);
    }
    /// Computes the motion of body k and its loads. If it carries beads, the loads have to wait for
    /// external forces on these; `keeps_forces` keeps the forces of before.
    template <bool positions, class Place>
    CATENA_HD void set_motion(Place k, bool keeps_forces) const {
        scan.set_motion<positions>(k);
        if constexpr (is_one_body<Place>)
            if (beads && !keeps_forces) {
                Mat3 const axes = orientation(k);
                beads.put(k, scan.motion.origin.load(k) - axes * r1(k), axes);
                return beads.clear_forces(k);
            }
        set_loads(k);
    }

    // Loads.

    /// Sets the load of joint k along its free directions: given torque, spring and damper.
    template <class Place>
    CATENA_HD void set_joint_load(Place k) const {
        using Real = RealAt<Place>;
        if (drive_of(k)) return write(joint_load, k, Vector<Real, 4>::zero());
        Vec3At<Place> qd = read(scan.state.qd, k);
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) qd = implicit.start.load(k);
        Vec3At<Place> const along =
            LoadedJoint<Place>{given, k, joints().type(k), read(scan.state.q, k), qd}.along();
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) return set_implicit(k, along);
        write(joint_load, k, load_along_axes(k, along));
    }
    /// Torque about the axis of a revolute joint that has no prescribed motion and is not implicit.
    CATENA_HD double torque_about_revolute(std::int64_t k) const {
        return LoadedAxis{given, k, scan.state.q, scan.state.qd}.along();
    }
    /// Inertia B along coordinate i of joint k.
    CATENA_HD double implicit_inertia(std::int64_t k, int i) const {
        double const stiffness = given.springs ? given.stiffness.at(k, i) : 0,
                     damping = given.dampers ? given.damping.at(k, i) : 0;
        return fused(implicit.of_stiffness, stiffness, implicit.of_damping * damping);
    }
    /// Columns of P of an implicit joint: motion along the last three directions of its handles per
    /// unit rate of each coordinate. Returns the number of coordinates.
    CATENA_HD int free_motions(std::int64_t k, Mat3& motions) const {
        motions = Mat3::zero();
        return with_motion(joints().joint[k], [&](auto motion) {
            return motion.free_motions(joint_at(k), [&] { return rotation(k); }, motions);
        });
    }
    /// Sets compliance and acceleration of implicit joint k from the torque along its coordinates.
    CATENA_HD void set_implicit(std::int64_t k, Vec3 const& torque_along) const {
        Mat3 motions;
        int const count = free_motions(k, motions);
        Vec3 along = torque_along, b = Vec3::zero();
        for (int i = 0; i < count; ++i) b[i] = implicit_inertia(k, i);
        // The springs' part of B is the inertia of a rotor in the axes of the outboard body, which
        // has a gyroscopic torque.
        if (is_ball(joints().joint[k]) && given.springs) {
            Vec3 const qd = scan.state.qd.load(k), stiffness = given.stiffness.load(k);
            Vec3 momentum;
            for (int i = 0; i < 3; ++i) momentum[i] = implicit.of_stiffness * stiffness[i] * qd[i];
            along = along - cross(qd, momentum);
        }
        auto compliance = Symmetric<double, 3>::zero();
        Vec3 yielding = Vec3::zero();
        for (int i = 0; i < count; ++i) {
            Vec3 const p = motions.column(i);
            double const yields = 1 / b[i];
            yielding = plus_scaled(yielding, yields * along[i], p);
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c <= r; ++c)
                    compliance(r, c) = fused(yields * p[r], p[c], compliance(r, c));
        }
        Vector<double, 6> numbers;
        for (int i = 0; i < 6; ++i) numbers[i] = compliance.data[i];
        implicit.compliance.store(k, numbers);
        implicit.yielding.store(k, yielding);
        joint_load.store(k, Vector<double, 4>::zero());
    }
    /// Load on the outboard body from the moments along the coordinates, see joint_load. In a
    /// universal joint the torque lies in the plane of its two axes.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> load_along_axes(Place k, Vec3At<Place> const& along) const {
        return with_motion(joints().type(k), [&](auto motion) {
            return motion.load(joint_at(k), [&] { return rotation(k); }, along);
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
        auto const e1 = transposed_times(inboard_turn, joints().axes(k));
        bool const across1 = joints().glides(k);
        moment = moment + torque_of(e1, in, across1);
        if (joints().has_screws) {
            Vector3 const f = force_of(e1, in, across1);
            push = push + f;
            moment = moment + cross(r1(k), f);
        }
        if (joints().ends_chain(k)) return;
        auto const out = read(joint_load, k + 1);
        auto const e2 = axes2(k);
        bool const across2 = joints().glides(k + 1);
        moment = moment - torque_of(e2, out, across2);
        if (joints().has_screws) {
            Vector3 const f = force_of(e2, out, across2);
            push = push - f;
            moment = moment - cross(r2(k), f);
        }
    }
    /// Wrench on body k from outside the chain and from carried beads, W.
    CATENA_HD Wrench wrench(std::int64_t k) const {
        Wrench w = beads ? beads.on_body(k, orientation(k)) : Wrench{Vec3::zero(), Vec3::zero()};
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
        return cross(omega(k), as_symmetric(read(inertia, k)) * omega(k));
    }

    /// Velocity-dependent part c of joint k's relative acceleration, including prescribed
    /// accelerations; M (src/dca/README.md, "Joint bias"). Returns the angular part and sets
    /// `linear`.
    template <class Place>
    CATENA_HD Vec3At<Place> joint_velocity_term(Place k, Vec3At<Place>& linear) const {
        using Real = RealAt<Place>;
        using Vector3 = Vec3At<Place>;
        Vector3 const w = rotation(k) * omega(k);
        auto const rate = joints().rate(scan.state, k);
        // The inboard or the outboard body's angular velocity: both give the same product.
        Vector3 angular = cross(w, rate.angular);
        linear = Real(2) * cross(w - rate.angular, rate.linear);
        auto const type = joints().type(k);
        angular =
            with_motion(type, [&](auto motion) { return motion.with_drift(joint_at(k), angular); });
        if constexpr (is_one_body<Place>)
            if (LocalDrive const* const drive = drive_of(k)) {
                Vec3 const qdd{{scene::acceleration_at(drive->first, time),
                                scene::acceleration_at(drive->second, time), 0}};
                return with_motion(type, [&](auto motion) {
                    return motion.with_prescribed(joint_at(k), qdd, angular, linear);
                });
            }
        return angular;
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
        if (!left.biases || !in_run.has(k)) set_bias(k, rotation(k), joints().axes(k));
    }
    /// Adds the terms' forces that act on body k in its own axes.
    template <class Place, class... Terms>
    CATENA_HD void add_terms(Place k, Vec3At<Place>& moment, Vec3At<Place>& push,
                             TypeList<Terms...>) const {
        (Terms::add_on_body(*this, k, moment, push), ...);
    }
    /// Sets the total torque and force on body k, except joint constraint forces.
    template <class Place>
    CATENA_HD void set_wrench(Place k) const {
        using Vector3 = Vec3At<Place>;
        // The gyroscopic torque of a planar chain is perpendicular to its axis and has no effect on
        // the motion. It may be large, so that its rounding would have one.
        Vector3 moment = joints().planar ? Vector3::zero() : -gyroscopic_torque(k),
                push = Vector3::zero();
        if (given.joint_loads) add_joint_loads(k, rotation(k), moment, push);
        if (has_wrenches) {
            auto const outside = wrench(k);
            auto const axes = orientation(k);
            moment = moment + transposed_times(axes, outside.torque);
            push = push + transposed_times(axes, outside.force);
        }
        add_terms(k, moment, push, terms::ForceTerms{});
        write(torque, k, moment);
        // Motion across the plane is impossible.
        if (joints().planar && has_forces) {
            Vector3 const axis = joints().axes(k).column(2);
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
        JointType const type = joints().type(k);
        bool const any_axis = is_ball(type) && !implicit.has(k);
        if (!floats(type) && !any_axis && !is_rigid(type) && !joints().planar) {
            angular = -transposed_times(axes1, joint_velocity_term(k, linear));
            linear = -transposed_times(axes1, linear);
        }
        // The ground accelerates by -g.
        if constexpr (is_one_body<Place>)
            if (joints().is_first[k] && !floats(type))
                linear = linear +
                         transposed_times(
                             axes1, to_meeting * transposed_times(orientation(k), given.gravity));
        Vector<RealAt<Place>, 6> b = dca::along_directions(
            joints().direction_of_screw(k), dca::AlongAxes<RealAt<Place>>{linear, angular});
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) add_yielding(b, -implicit.yielding.load(k));
        store_first(bias, k, directions, b);
    }
    /// Adds the acceleration of an implicit joint along its last three directions.
    CATENA_HD static void add_yielding(Vector<double, 6>& b, Vec3 const& yielding) {
        for (int i = 0; i < 3; ++i) b[3 + i] += yielding[i];
    }

    // Noise of a thermostat.

    /// Sets random loads. The solver's response to them is normal, with the inverse of the chain's
    /// mass matrix as covariance, including the parts of springs and dampers.
    CATENA_HD void set_noise(std::int64_t k, std::uint64_t body, std::uint64_t seed,
                             std::uint64_t step) const {
        Vec3 const turning = normal3(seed, step, body, NoiseStage::thermostat_angular);
        Sym3 const factor = dca::factorize(as_symmetric(inertia.load(k)), 3);  // J = L S L^T.
        Vec3 scaled, moment;
        for (int i = 0; i < 3; ++i) scaled[i] = turning[i] / std::sqrt(factor(i, i));
        for (int i = 0; i < 3; ++i) {
            moment[i] = scaled[i];
            for (int j = 0; j < i; ++j) moment[i] = fused(factor(i, j), scaled[j], moment[i]);
        }
        torque.store(k, moment);
        force.store(k,
                    std::sqrt(mass.at(k, 0)) * normal3(seed, step, body, NoiseStage::thermostat));
        auto b = Vector<double, 6>::zero();
        if (implicit.has(k)) {
            Vec3 const along = normal3(seed, step, body, NoiseStage::thermostat_joint);
            Mat3 motions;
            int const count = free_motions(k, motions);
            for (int i = 0; i < count; ++i)
                add_yielding(b,
                             -(along[i] / std::sqrt(implicit_inertia(k, i))) * motions.column(i));
        }
        store_first(bias, k, directions, b);
    }
};

}  // namespace catena
