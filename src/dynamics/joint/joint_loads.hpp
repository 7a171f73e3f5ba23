// What bodies of chains in joint coordinates feel at a configuration, for every Space.
#pragma once

#include "dynamics/body_loads.hpp"
#include "dynamics/joint/jointed_tips.hpp"
#include "kinematics/carried_beads.hpp"
#include "kinematics/joint_scan.hpp"
#include "math/philox.hpp"

namespace catena {

/// Springs K and dampers C within a step of length h: B = c h^2 K + h C / 2 in P^T phi = tau - B
/// u', c by rotor_of_spring(). The joint's force then is unknown along every direction, and its
/// sides part by u' = B^-1 (tau - P^T phi).
struct ImplicitJoints {
    double of_stiffness = 0, of_damping = 0;  // what of K and of C is in B
    std::uint8_t const* joint = nullptr;      // whether joint k is one; null where none is
    View<6> compliance;  // P B^-1 P^T along the joint's axes (a sliding one's: its free direction
                         // is the last)
    View<3> yielding;    // P B^-1 tau, along the same
    View<3> start;       // velocities by which dampers act: B has what a step adds

    CATENA_HD bool has(std::int64_t k) const { return joint && joint[k] != 0; }
    /// Several bodies next to each other have none.
    template <dca::SeveralBodies Place>
    CATENA_HD bool has(Place const&) const {
        return false;
    }
};

/// Revolute joints that a solver which goes_by_revolutes() knows by itself: of runs of several
/// bodies, but of no body that begins a chain. Those of bodies side by side are such
/// (joint_lanes.cpp).
struct RevolutesInRuns {
    static constexpr std::uint8_t within = 1,
                                  first = 2;  // of a run's first body; 0: no such revolute joint
    std::uint8_t const* joint = nullptr;
    CATENA_HD bool has(std::int64_t k) const { return joint[k] != 0; }
    CATENA_HD bool begins_run(std::int64_t k) const { return joint[k] == first; }
    template <dca::SeveralBodies Place>
    CATENA_HD bool has(Place const&) const {
        return true;
    }
    /// Or may.
    template <dca::SeveralBodies Place>
    CATENA_HD bool begins_run(Place const&) const {
        return true;
    }
};
/// What it makes by itself of velocities: LoadsView::gyroscopic, where nothing else is in the
/// torques, revolute_rate; and RevoluteLoads, where the update that needs motions joint by joint
/// finds them, and no step before (JointDynamicsIn::follow_revolutes).
struct LeftToSolver {
    bool gyroscopic = false, biases = false, motions = false;
};

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
    // What a solution needs and finds.
    View<4> joint_load;  // known load of joint k on body k: torque along the joint's axes and force
                         // along its last one
    View<3> torque, force, alpha, acceleration;
    DirectionsView bias;
    View<4> outboard_end;  // entry -1: outboard_end_of() of the body before this rank's first

    CATENA_HD JointsView const& joints() const { return scan.joints; }
    // A place k: one body, or several next to each other (dca/lane_access.hpp, JointsView::type).
    template <class Place>
    CATENA_HD Mat3At<Place> turn(Place k) const {
        return to_matrix(as_quaternion(read(scan.motion.joint_turn, k)));
    }
    template <class Place>
    CATENA_HD Mat3At<Place> orientation(Place k) const {
        return to_matrix(as_quaternion(read(scan.motion.orientation, k)));
    }
    template <class Place>
    CATENA_HD Vec3At<Place> omega(Place k) const {
        return read(scan.motion.omega, k);
    }
    template <class Place>
    CATENA_HD Vec3At<Place> r1(Place k) const {
        return read(joints().r1, k);
    }
    template <class Place>
    CATENA_HD Mat3At<Place> axes2(Place k) const {
        return axes_of(scan.motion.axes2.origin ? read(scan.motion.axes2, k)
                                                : read(fixed_axes2, k));
    }
    template <class Place>
    CATENA_HD Vec3At<Place> r2(Place k) const {
        return scan.motion.r2.origin ? read(scan.motion.r2, k) : read(fixed_r2, k);
    }
    /// What drives joint k; null: nothing. Of several bodies none is driven.
    CATENA_HD LocalDrive const* drive_of(std::int64_t k) const {
        return joints().drives > 0 ? joints().drive_of(k) : nullptr;
    }
    template <dca::SeveralBodies Place>
    CATENA_HD LocalDrive const* drive_of(Place const&) const {
        return nullptr;
    }

    // Configuration.

    template <bool positions, class Place>
    CATENA_HD void set_relative(Place k) const {
        scan.set_relative<positions>(k);
        if (given.joint_loads) set_joint_load(k);
    }
    /// With the loads, but where these wait for forces from outside.
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

    /// Along the joint's free directions: given, spring and damper.
    template <class Place>
    CATENA_HD void set_joint_load(Place k) const {
        using Real = RealAt<Place>;
        if (drive_of(k)) return write(joint_load, k, Vector<Real, 4>::zero());
        Vec3At<Place> along = read(given.torque, k);
        Vec3At<Place> qd = read(scan.state.qd, k);
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) qd = implicit.start.load(k);
        auto const q = read(scan.state.q, k);
        if (given.springs) {
            auto const stiffness = read(given.stiffness, k);
            auto const rest = read(given.rest, k);
            if (joints().type(k) != JointType::spherical) {
                for (int i = 0; i < 2; ++i) along[i] = along[i] - stiffness[i] * (q[i] - rest[i]);
            } else if constexpr (is_one_body<Place>) {
                along = along +
                        spherical_spring_torque(stiffness, as_quaternion(rest), as_quaternion(q));
            }
        }
        if (given.dampers) {
            auto const damping = read(given.damping, k);
            for (int i = 0; i < 3; ++i) along[i] = along[i] - damping[i] * qd[i];
        }
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) return set_implicit(k, along);
        write(joint_load, k, load_along_axes(k, along));
    }
    /// The same of a revolute joint that is neither driven nor implicit: about its axis.
    CATENA_HD double torque_about_revolute(std::int64_t k) const {
        double along = given.torque.at(k, 0);
        if (given.springs)
            along =
                along - given.stiffness.at(k, 0) * (scan.state.q.at(k, 0) - given.rest.at(k, 0));
        if (given.dampers) along = along - given.damping.at(k, 0) * scan.state.qd.at(k, 0);
        return along;
    }
    /// B along a joint's coordinate i.
    CATENA_HD double implicit_inertia(std::int64_t k, int i) const {
        double const stiffness = given.springs ? given.stiffness.at(k, i) : 0,
                     damping = given.dampers ? given.damping.at(k, i) : 0;
        return fused(implicit.of_stiffness, stiffness, implicit.of_damping * damping);
    }
    /// P of an implicit joint: what a unit rate of each coordinate is along the joint's axes.
    /// Returns how many there are.
    CATENA_HD int free_motions(std::int64_t k, Mat3& motions) const {
        Mat3 const axes = joints().axes(k);
        motions = Mat3::zero();
        switch (joints().joint[k]) {
            case JointType::spherical:
                motions = transposed_times(axes, turn(k));
                return 3;
            case JointType::universal:
                motions.set_column(0, transposed_times(axes, joints().first_axis.load(k)));
                motions.set_column(1, Vec3{{0, 0, 1}});
                return 2;
            default:
                motions.set_column(0, Vec3{{0, 0, joints().screw_of(k)[2]}});
                return 1;
        }
    }
    CATENA_HD void set_implicit(std::int64_t k, Vec3 const& torque_along) const {
        Mat3 motions;
        int const count = free_motions(k, motions);
        Vec3 along = torque_along, b = Vec3::zero();
        for (int i = 0; i < count; ++i) b[i] = implicit_inertia(k, i);
        if (count == 3 &&
            given.springs) {  // their part of B is a rotor's, whose axes are the outboard body's
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
    /// On the outboard body, from the moments along the coordinates: torque along the joint's axes
    /// (universal: within the plane of its axes) and force along the last one.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> load_along_axes(Place k, Vec3At<Place> const& along) const {
        using Real = RealAt<Place>;
        Real const none(0);
        auto const axes = joints().axes(k);
        switch (joints().type(k)) {
            case JointType::spherical: {
                auto const t = transposed_times(axes, turn(k) * along);
                return {{t[0], t[1], t[2], none}};
            }
            case JointType::universal: {
                auto const first = read(joints().first_axis, k), second = axes.column(2);
                Real const g = dot(first, second),
                           x = (along[0] - g * along[1]) / (Real(1) - g * g), y = along[1] - g * x;
                auto const t = transposed_times(axes, plus_scaled(x * first, y, second));
                return {{t[0], t[1], t[2], none}};
            }
            case JointType::free:
            case JointType::link:
            case JointType::weld:
                return Vector<Real, 4>::zero();
            default:
                auto const s = joints().screw_of(k);
                return {{none, none, s[0] / s[2] * along[0], s[1] / s[2] * along[0]}};
        }
    }
    /// Adds what the joints at both ends of body k do along their free directions; B.
    template <class Place>
    CATENA_HD void add_joint_loads(Place k, Mat3At<Place> const& inboard_turn,
                                   Vec3At<Place>& moment, Vec3At<Place>& push) const {
        using Vector3 = Vec3At<Place>;
        auto const in = read(joint_load, k);
        auto const e1 = transposed_times(inboard_turn, joints().axes(k));
        moment = moment + e1 * Vector3{{in[0], in[1], in[2]}};
        if (joints().has_screws) {
            Vector3 const f = in[3] * e1.column(2);
            push = push + f;
            moment = moment + cross(r1(k), f);
        }
        if (joints().ends_chain(k)) return;
        auto const out = read(joint_load, k + 1);
        auto const e2 = axes2(k);
        moment = moment - e2 * Vector3{{out[0], out[1], out[2]}};
        if (joints().has_screws) {
            Vector3 const f = out[3] * e2.column(2);
            push = push - f;
            moment = moment - cross(r2(k), f);
        }
    }
    /// From outside the chain and from carried beads.
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
    /// omega x J omega.
    template <class Place>
    CATENA_HD Vec3At<Place> gyroscopic_torque(Place k) const {
        return cross(omega(k), as_symmetric(read(inertia, k)) * omega(k));
    }

    /// The velocity-dependent part c of joint k's relative acceleration (src/dca/README.md, "Joint
    /// bias"), with what a drive prescribes; M.
    template <class Place>
    CATENA_HD Vec3At<Place> joint_velocity_term(Place k, Vec3At<Place>& linear) const {
        using Real = RealAt<Place>;
        using Vector3 = Vec3At<Place>;
        Vector3 const w = turn(k) * omega(k);
        auto const rate = joints().rate(scan.state, k);
        Vector3 angular =
            cross(w, rate.angular);  // the outboard body's w does as well as the inboard one's
        linear = Real(2) * cross(w - rate.angular, rate.linear);
        bool const universal = joints().type(k) == JointType::universal;
        auto const axes = joints().axes(k);
        if (universal) {
            Vector3 const qd = read(scan.state.qd, k);
            angular = plus_scaled(angular, qd[0] * qd[1],
                                  cross(read(joints().first_axis, k), axes.column(2)));
        }
        if constexpr (is_one_body<Place>)
            if (LocalDrive const* const drive = drive_of(k)) {
                double const first = scene::acceleration_at(drive->first, time),
                             second = scene::acceleration_at(drive->second, time);
                if (universal)
                    return angular + first * joints().first_axis.load(k) + second * axes.column(2);
                Vec3 const s = joints().screw_of(k);
                linear = plus_scaled(linear, s[1] * s[2] * first, axes.column(2));
                return plus_scaled(angular, s[0] * s[2] * first, axes.column(2));
            }
        return angular;
    }

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
        if (!left.biases || !in_run.has(k)) set_bias(k, turn(k), joints().axes(k));
    }
    template <class Place>
    CATENA_HD void set_wrench(Place k) const {
        using Vector3 = Vec3At<Place>;
        Vector3 const w = omega(k);
        // In a plane the gyroscopic torque is across it, and large: only its rounding would count.
        Vector3 moment = joints().planar ? Vector3::zero() : -gyroscopic_torque(k),
                push = Vector3::zero();
        if (given.joint_loads) add_joint_loads(k, turn(k), moment, push);
        if (has_wrenches) {
            auto const outside = wrench(k);
            auto const axes = orientation(k);
            moment = moment + transposed_times(axes, outside.torque);
            push = push + transposed_times(axes, outside.force);
        }
        if (given.dragged) {
            auto const drag = read(given.drag, k);
            push = plus_scaled(push, -drag[0], read(scan.motion.velocity, k) - cross(w, r1(k)));
            moment = plus_scaled(moment, -drag[1], w);
        }
        write(torque, k, moment);
        if (joints().planar && has_forces) {  // nothing moves across the plane
            Vector3 const axis = joints().axes(k).column(2);
            push = plus_scaled(push, -dot(axis, push), axis);
        }
        if (has_forces) write(force, k, push);
    }
    template <class Place>
    CATENA_HD void set_bias(Place k, Mat3At<Place> const& to_meeting,
                            Mat3At<Place> const& axes1) const {
        using Vector3 = Vec3At<Place>;
        Vector3 linear = Vector3::zero(), angular = Vector3::zero();  // -c along the joint's axes
        JointType const type = joints().type(k);
        bool const any_axis = type == JointType::spherical && !implicit.has(k);
        if (type != JointType::free && !any_axis && type != JointType::weld && !joints().planar) {
            angular = -transposed_times(axes1, joint_velocity_term(k, linear));
            linear = -transposed_times(axes1, linear);
        }
        if constexpr (is_one_body<Place>)
            if (joints().is_first[k] && type != JointType::free)  // ground accelerates by -g
                linear = linear +
                         transposed_times(
                             axes1, to_meeting * transposed_times(orientation(k), given.gravity));
        auto const s = joints().direction_of_screw(k);
        Vector<RealAt<Place>, 6> b{{linear[0], linear[1], s.c * linear[2] - s.s * angular[2],
                                    angular[0], angular[1], s.s * linear[2] + s.c * angular[2]}};
        if constexpr (is_one_body<Place>)
            if (implicit.has(k)) add_yielding(b, -implicit.yielding.load(k));
        store_first(bias, k, directions, b);
    }
    CATENA_HD static void add_yielding(Vector<double, 6>& b, Vec3 const& yielding) {
        for (int i = 0; i < 3; ++i) b[3 + i] += yielding[i];
    }

    // Noise of a thermostat.

    /// Loads whose answer is normal with the inverse of the chain's matrix, springs' and dampers'
    /// part included, for covariance.
    CATENA_HD void set_noise(std::int64_t k, std::uint64_t body, std::uint64_t seed,
                             std::uint64_t step) const {
        Vec3 const turning = normal3(seed, step, body, NoiseStage::thermostat_angular);
        Sym3 const factor = dca::factorize(as_symmetric(inertia.load(k)), 3);  // J = L S L^T
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
