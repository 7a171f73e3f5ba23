// Scan over runs on revolute joints for solvers that release revolute joints from articulated-body
// inertias (ChainSolver::eliminates_revolute_joints()). Motions within runs are not stored. The
// motion of a run's first body is computed once that of the body before it is known. In any Space;
// JointLanes has the counterpart with runs side by side.
#pragma once

#include "dynamics/joint/joint_loads.hpp"
#include "joints/joint_models.hpp"

namespace catena {

/// Interface of the scan for a Space's tree passes (HostSpace::ScanTree). Precondition: all joints
/// except those of chains' first bodies are revolute, and none has prescribed motion.
struct RevoluteScan {
    using Value = MotionNumbers<false>;
    JointLoads loads;
    /// set_relative() has already been called for every body.
    bool joint_by_joint = false;
    /// Rotations of all joints are requested, not only those of a run's first body and last two
    /// bodies.
    bool all_turns = false;

    /// Composes the motions along a run. Unless they are known, it also stores the rotations and
    /// torques of the joints.
    CATENA_HD Value of_run(dca::Run const& run) const {
        // Bodies loaded at a time, so that their loads overlap.
        constexpr int few = 4;
        int const count = static_cast<int>(run.count);
        Motion m = of_body<true>(run, 0);
        int i = 1;
        for (; i + few <= count; i += few) {
            Motion next[few];
            CATENA_UNROLL
            for (int j = 0; j < few; ++j) next[j] = of_body<false>(run, i + j);
            CATENA_UNROLL
            for (int j = 0; j < few; ++j) m = compose<false>(m, next[j]);
        }
        for (; i < count; ++i) m = compose<false>(m, of_body<false>(run, i));
        return packed<false>({normalized(m.rotation), m.omega, Vec3::zero(), Vec3::zero()});
    }
    CATENA_HD Value joined(Value const& inboard, Value const& outboard) const {
        return motions().joined(inboard, outboard);
    }
    CATENA_HD Value whole(std::int64_t slot) const { return motions().whole(slot); }
    CATENA_HD void set_whole(std::int64_t slot, Value const& value) const {
        motions().set_whole(slot, value);
    }
    CATENA_HD Value before(std::int64_t slot) const { return motions().before(slot); }
    CATENA_HD void set_before(std::int64_t slot, Value const& value) const {
        motions().set_before(slot, value);
    }
    CATENA_HD MotionScan<false> motions() const { return {loads.moved.scan}; }

    /// Computes, after the scan, the motion of a run's first body and those of its loads that the
    /// solver does not know. For a run of one body it also computes the torque.
    CATENA_HD void begin(dca::Run const& run) const {
        loads.moved.scan.set_motion<false>(run.body);
        if (run.count == 1) loads.set_torque(run.body);
        loads.set_biases(run.body);
    }

  private:
    /// Motion and load of joint i of the run, limited to what the solver needs (compare
    /// JointLoads::set_relative). `may_begin`: body i may be the first of the run.
    template <bool may_begin>
    CATENA_HD Motion of_body(dca::Run const& run, int i) const {
        JointScan const& s = loads.moved.scan;
        std::int64_t const k = run.body + i;
        if (joint_by_joint) return s.load<false>(k);
        // All loads come first, so that a GPU waits for them together.
        bool const is_revolute = !may_begin || i > 0 || pivots(s.joints.joint[k]);
        Vec3 const axis = s.joints.axis(k);
        double const angle = s.state.q.at(k, 0), rate = s.state.qd.at(k, 0);
        Quat const frame = as_quaternion(read(s.joints.joint_rotation, k));
        double const torque = loads.given.joint_loads ? loads.torque_about_revolute(k) : 0.0;
        // The first body of a chain may have any joint.
        if constexpr (may_begin)
            if (!is_revolute) {
                loads.set_relative<false>(k);
                return s.load<false>(k);
            }
        Quat const rotation = from_axis_angle(axis, angle);
        Motion const m{frame * rotation, rate * axis, Vec3::zero(), Vec3::zero()};
        bool const begins = may_begin && i == 0;
        if (all_turns || begins || i >= run.count - 2)
            write(s.motion.joint_turn, k, as_vector(rotation));
        write(s.rotation, k, as_vector(m.rotation));
        if (begins) write(s.omega, k, m.omega);
        if (!loads.given.joint_loads) return m;
        if (begins)
            loads.set_joint_load(k);
        else
            loads.joint_load.at(k, RevoluteLoads::about_revolute) = torque;
        return m;
    }
};

}  // namespace catena
