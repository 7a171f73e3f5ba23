// The scan over runs on revolute joints whose solver goes_by_revolutes(): of motions within runs
// nothing is kept, and runs' first bodies come to move when what lies before them is known. In any
// Space; of runs side by side: JointLanes.
#pragma once

#include "dynamics/joint/joint_loads.hpp"

namespace catena {

/// As a space's scans want it (HostSpace::ScanTree). Precondition: joints but those of chains'
/// first bodies are revolute joints, none is driven.
struct RevoluteScan {
    using Value = MotionNumbers<false>;
    /// Of a body against the one before it, with what going on by it takes.
    struct Step {
        Quat rotation;
        Vec3 omega;
        Mat3 axes;
    };
    JointLoads loads;
    bool joint_by_joint = false;  // set_relative() of every body came before
    bool all_turns = false;  // are asked for, not those of runs' first bodies and last two alone

    /// With the turns and torques of its revolute joints, where these are not known.
    CATENA_HD Value of_run(dca::Run const& run) const {
        constexpr int few = 4;  // bodies at a time, so that their loads are under way together
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
        return ended(m.rotation, m.omega);
    }
    // The same body by body: from step() of the first one go_on() by those of the others, and ended().
    CATENA_HD Step step(dca::Run const& run, int i) const {
        Motion const m = of_body<true>(run, i);
        return {m.rotation, m.omega, to_matrix(m.rotation)};
    }
    CATENA_HD static void go_on(Quat& rotation, Vec3& omega, Step const& next) {
        rotation = rotation * next.rotation;
        omega = transposed_times(next.axes, omega) + next.omega;
    }
    CATENA_HD static Value ended(Quat const& rotation, Vec3 const& omega) {
        return packed<false>({normalized(rotation), omega, Vec3::zero(), Vec3::zero()});
    }
    CATENA_HD Value joined(Value const& inboard, Value const& outboard) const { return motions().joined(inboard, outboard); }
    CATENA_HD Value whole(std::int64_t slot) const { return motions().whole(slot); }
    CATENA_HD void set_whole(std::int64_t slot, Value const& value) const { motions().set_whole(slot, value); }
    CATENA_HD Value before(std::int64_t slot) const { return motions().before(slot); }
    CATENA_HD void set_before(std::int64_t slot, Value const& value) const { motions().set_before(slot, value); }
    CATENA_HD MotionScan<false> motions() const { return {loads.scan}; }

    /// When the scan is through: of its first body, all that the solver does not know, and of a body by itself what acts on it.
    CATENA_HD void begin(dca::Run const& run) const {
        loads.scan.set_motion<false>(run.body);
        if (run.count == 1) loads.set_torque(run.body);
        loads.set_biases(run.body);
    }

    /// Whether begin() may come before the scan is through: before a chain is the ground. A run of one body ends its chain, so that none
    /// waits for what another rank has.
    CATENA_HD bool begins_at_ground(dca::Run const& run) const { return loads.scan.joints.starts_chain(run.body); }

  private:
    /// As JointLoads::set_relative, of what the solver asks for. `may_begin`: else it is not the run's first.
    template <bool may_begin>
    CATENA_HD Motion of_body(dca::Run const& run, int i) const {
        JointScan const& s = loads.scan;
        std::int64_t const k = run.body + i;
        if (joint_by_joint) return s.load<false>(k);
        // All reads come first: a GPU waits for them together.
        bool const is_revolute = !may_begin || i > 0 || s.joints.joint[k] == JointType::revolute;
        Vec3 const axis = s.joints.axis(k);
        double const angle = s.state.q.at(k, 0), rate = s.state.qd.at(k, 0);
        Quat const frame = as_quaternion(read(s.joints.joint_rotation, k));
        double const torque = loads.given.joint_loads ? loads.torque_about_revolute(k) : 0.0;
        if constexpr (may_begin)
            if (!is_revolute) {  // but whatever begins a chain
                loads.set_relative<false>(k);
                return s.load<false>(k);
            }
        Quat const turn = from_axis_angle(axis, angle);
        Motion const m{frame * turn, rate * axis, Vec3::zero(), Vec3::zero()};
        bool const begins = may_begin && i == 0;
        if (all_turns || begins || i >= run.count - 2) write(s.motion.joint_turn, k, as_vector(turn));
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
