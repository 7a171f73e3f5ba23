// Forward kinematics of chains in joint coordinates. A joint's motion (rotation, translation, angular and linear velocity)
// composes associatively along the chain, so the way along it is a scan over the canonical units.
#pragma once

#include <memory>
#include <vector>

#include "chain/chain_group.hpp"
#include "dca/executor.hpp"

namespace catena {

/// State of body chains in joint coordinates (rules of BodyArrays).
struct JointState {
    Field<4> q;
    Field<3> qd;
    std::vector<Vec3> base_position, base_velocity;  // one a piece; counts where the piece starts on a free base: origin of body 1, W
    double time = 0;
};
JointState make_joint_state(ChainGroup const&, Scene const&);
/// Sets q and qd of driven joints to their courses' at the state's time.
void follow_courses(ChainGroup const&, JointState&);

/// The motion of a frame B against a frame A.
struct Motion {
    Quat rotation;     // Q_AB
    Vec3 omega;        // of B against A, B
    Vec3 translation;  // of B's origin from A's, A
    Vec3 velocity;     // of B's origin against A, B
};
/// Motion of C against A from those of B against A and C against B. Without `positions` translation and velocity stay zero.
template <bool positions>
Motion compose(Motion const& ab, Motion const& bc);
/// The coordinates' rates as a relative motion of joint k: angular and linear velocity of the outboard side against the inboard one, M.
struct JointRate {
    Vec3 angular, linear;
};
JointRate joint_rate(ChainGroup const&, JointState const&, std::int64_t k);

/// What a pass over the chain fills. Poses and velocities are left out where nobody asks for them.
struct BodyMotion {
    Field<4> joint_turn;   // quaternion of B in the meeting frame M of its inboard joint
    Field<4> orientation;  // of B in W
    Field<3> omega;        // of B, B
    Field<3> origin;       // of B, W
    Field<3> velocity;     // of B's origin, B
    // Where the meeting frames of outboard joints move in their inboard body (else empty): as ConfigurationView.
    Field<3> r2;
    Field<9> axes2;
};
BodyMotion make_body_motion(ChainGroup const&);

class JointKinematics {
  public:
    JointKinematics(ChainGroup const&, Executor const&, Communicator const&);
    /// Collective where a chain is shared by ranks. `with_positions` fills origin and velocity as well.
    void evaluate(JointState const&, bool with_positions, BodyMotion& out) const;

  private:
    Motion joint_motion(JointState const&, std::size_t piece, std::int64_t k) const;
    void keep_in_plane(std::int64_t k, Motion&) const;
    template <bool positions>
    void evaluate(JointState const&, BodyMotion& out) const;
    template <bool positions>
    Motion unit_motion(JointState const&, LocalUnit const&) const;
    template <bool positions>
    std::vector<Motion> starts_of_units(JointState const&) const;
    template <bool positions>
    void gather_shared(std::vector<Motion> const& own, std::vector<Motion>& starts) const;
    void set_meetings(JointState const&, BodyMotion& out) const;

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    std::vector<LocalUnit> units_;
    bool composites_needed_ = false;  // a local chain has more than one unit
};

}  // namespace catena
