// Motion of a group's bodies in any Space, and what is known of it.
#pragma once

#include "dynamics/body_loads.hpp"
#include "kinematics/joint_kinematics.hpp"

namespace catena {

/// Rotations that the arrays of a scan hold (JointKinematics::rotations()).
enum class HeldRotations : std::uint8_t {
    across_runs,     // As the last scan has left them.
    of_joints,       // Those of the joints at the last updated configuration.
    of_joints_ahead  // Relative motions of the joints at the state to which the last step led.
};
/// Bodies whose orientations are known at the last updated configuration.
enum class Oriented : std::uint8_t { first_bodies, all_bodies };

/// Storage of the motion, and its phase: what is known of it.
template <class Space>
class JointMotionIn {
  public:
    /// The group and the communicator must outlive this object.
    JointMotionIn(ChainGroup const& group, Space const& space, Communicator const& communicator,
                  BodyLoads const& given)
        : needs_positions_(given.use_positions() || group.has_closures() || group.carried.in_scene),
          needs_orientations_(given.use_orientations() || needs_positions_),
          kinematics_(group, space, communicator),
          fields_(group, space) {}

    JointKinematics<Space>& kinematics() { return kinematics_; }
    MotionFields<Space> const& fields() const { return fields_; }
    MotionView view() { return fields_.view(); }
    JointScan scan(StateView const& state) { return kinematics_.scan(state, fields_.view()); }
    /// True if loads depend on the positions of bodies.
    bool needs_positions() const { return needs_positions_; }
    bool needs_orientations() const { return needs_orientations_; }
    bool has_rotations_of_joints() const { return held_ == HeldRotations::of_joints; }

    /// Computes the motion at a state, positions included.
    void move(StateView const& state) { evaluate(state, true); }
    /// Computes the motion at a state unless the orientations of all bodies are known.
    void orient(StateView const& state) {
        if (oriented_ == Oriented::first_bodies) evaluate(state, false);
    }

    // Events that change the phase.

    /// Notes that a scan over all bodies begins. Returns true if the relative motions of the joints
    /// are already known.
    bool begin_scan() {
        oriented_ = needs_orientations_ ? Oriented::all_bodies : Oriented::first_bodies;
        return std::exchange(held_, HeldRotations::across_runs) == HeldRotations::of_joints_ahead;
    }
    /// Variant of begin_scan() for a scan that leaves the rotations of the joints.
    bool begin_scan_of_runs() {
        return std::exchange(held_, HeldRotations::of_joints) == HeldRotations::of_joints_ahead;
    }
    /// Notes that the rotations of the joints have been computed again.
    void found_rotations() { held_ = HeldRotations::of_joints; }
    /// Notes that some rank knows the orientations of first bodies only. Computing the others is
    /// collective, so that all ranks note it.
    void forget_orientations() { oriented_ = Oriented::first_bodies; }
    /// Notes that the state has changed. `ahead`: relative motions of the joints were computed.
    void changed_state(bool ahead) {
        if (ahead)
            held_ = HeldRotations::of_joints_ahead;
        else if (held_ == HeldRotations::of_joints_ahead)
            held_ = HeldRotations::across_runs;
    }

  private:
    void evaluate(StateView const& state, bool positions) {
        held_ = HeldRotations::across_runs;
        oriented_ = Oriented::all_bodies;
        kinematics_.evaluate(state, positions, fields_.view());
    }

    bool needs_positions_, needs_orientations_;
    JointKinematics<Space> kinematics_;
    MotionFields<Space> fields_;
    HeldRotations held_ = HeldRotations::across_runs;
    Oriented oriented_ = Oriented::all_bodies;
};

}  // namespace catena
