// The scan over runs on hinges whose solver goes_by_hinges(): of motions within runs nothing is kept, and runs' first bodies come to move
// when what lies before them is known. In any Space; of runs side by side: JointLanes.
#pragma once

#include "integrate/joint_loads.hpp"

namespace catena {

/// As a space's scans want it (HostSpace::ScanTree). Precondition: joints but those of chains' first bodies are hinges, none is driven.
struct HingeScan {
    using Value = MotionNumbers<false>;
    JointLoads loads;
    bool joint_by_joint = false;  // set_relative() of every body came before
    bool all_turns = false;       // are asked for, not those of runs' first bodies and last two alone

    /// With the turns and torques of its hinges, where these are not known.
    CATENA_HD Value of_run(dca::Run const& run) const {
        constexpr int few = 4;  // bodies at a time, so that their loads are under way together
        std::int64_t const end = run.body + run.count;
        if (!joint_by_joint) loads.set_relative<false>(run.body);
        Motion m = loads.scan.load<false>(run.body);
        std::int64_t k = run.body + 1;
        for (; k + few <= end; k += few) {
            Motion next[few];
        CATENA_UNROLL
            for (int i = 0; i < few; ++i) next[i] = of_hinge(k + i, k + i >= end - 2);
            CATENA_UNROLL
            for (int i = 0; i < few; ++i) m = compose<false>(m, next[i]);
        }
        for (; k < end; ++k) m = compose<false>(m, of_hinge(k, k >= end - 2));
        m.rotation = normalized(m.rotation);
        return packed<false>(m);
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

  private:
    /// As JointLoads::set_relative, of what the solver asks for.
    CATENA_HD Motion of_hinge(std::int64_t k, bool at_end) const {
        JointScan const& s = loads.scan;
        if (joint_by_joint) return s.load<false>(k);
        Vec3 const axis = s.joints.axis(k);
        Quat const turn = from_axis_angle(axis, s.state.q.at(k, 0)), rotation = as_quaternion(read(s.joints.joint_rotation, k)) * turn;
        if (at_end || all_turns) write(s.motion.joint_turn, k, as_vector(turn));
        write(s.rotation, k, as_vector(rotation));
        if (loads.given.joint_loads) loads.joint_load.at(k, HingeLoads::about_hinge) = loads.torque_about_hinge(k);
        return {rotation, s.state.qd.at(k, 0) * axis, Vec3::zero(), Vec3::zero()};
    }
};

}  // namespace catena
