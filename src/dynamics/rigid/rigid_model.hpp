// Constant properties of the bodies of rigid chains in absolute coordinates, in any Space.
#pragma once

#include "dca/host_space.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/rigid/rigid_start.hpp"
#include "joints/joint_models.hpp"
#include "kinematics/rotor.hpp"

namespace catena {

/// Constant properties of bodies, as plain pointers for loops over bodies. Handle 1 of body k lies
/// at x + R r1 and handle 2 at x + R r2, with x the centre of mass and R the body's rotation
/// matrix. Joints hold two handles together; links keep them at the link's length. A point bead is
/// a body without inertia that never rotates.
struct RigidModel {
    bool linked = false;
    double reach = 1;  // Length that openings of joints are divided by, nm.
    /// True for body k if it begins or ends its chain.
    std::uint8_t const *is_first = nullptr, *is_last = nullptr;
    JointType const* joint = nullptr;
    LocalPiece const* piece = nullptr;
    std::int64_t pieces = 0;
    ConstView<1> mass, inverse_mass, length;
    ConstView<6> inertia;
    ConstView<3> r1, r2;
    ConstView<4> joint_frame;     // Quaternion of J in the inboard body (LocalJoints::rotation).
    ConstView<4> principal_axes;  // Quaternion of P in B.
    /// Principal moments of inertia; 0 for a bead.
    ConstView<3> principal_moment;

    /// True if body k is a point bead.
    CATENA_HD bool is_bead(std::int64_t k) const { return principal_moment.at(k, 0) == 0; }
    /// True if body k has an inboard joint or link.
    CATENA_HD bool is_joined(std::int64_t k) const { return !floats(joint[k]); }
    CATENA_HD LocalPiece const& piece_of(std::int64_t k) const {
        return catena::piece_of(piece, pieces, k);
    }
    CATENA_HD PrincipalFrame principal_frame(std::int64_t k) const {
        return {as_quaternion(principal_axes.load(k)), principal_moment.load(k)};
    }
};

/// Storage behind RigidModel.
template <class Space>
class RigidModelIn {
    template <int D>
    using Fixed = typename Space::template Fixed<D>;
    template <class T>
    using List = typename Space::template List<T>;

  public:
    /// The group must outlive this object. Collective.
    RigidModelIn(ChainGroup const& group, Scene const& scene, Communicator const& communicator)
        : linked_(group.linked),
          reach_(group.linked ? 1.0 : reach_of_joints(group, communicator)),
          principal_(principal_frames(group)),
          local_pieces_(local_pieces(group, scene)),
          is_first_(group.ends.is_first),
          is_last_(group.ends.is_last),
          joint_(group.joints.type),
          pieces_(local_pieces_),
          mass_(group.bodies.mass),
          inverse_mass_(group.bodies.inverse_mass),
          length_(group.joints.length),
          inertia_(group.bodies.inertia),
          r1_(group.bodies.r1),
          r2_(group.bodies.r2),
          joint_frame_(group.joints.rotation),
          principal_axes_(principal_.axes),
          principal_moment_(principal_.moment) {}

    RigidModel view() const {
        return {linked_,
                reach_,
                is_first_.data(),
                is_last_.data(),
                joint_.data(),
                pieces_.data(),
                std::ssize(local_pieces_),
                mass_.view(),
                inverse_mass_.view(),
                length_.view(),
                inertia_.view(),
                r1_.view(),
                r2_.view(),
                joint_frame_.view(),
                principal_axes_.view(),
                principal_moment_.view()};
    }

  private:
    bool linked_;
    double reach_;
    // On the host a List and a Fixed are views.
    PrincipalFrames principal_;
    std::vector<LocalPiece> local_pieces_;
    List<std::uint8_t> is_first_, is_last_;
    List<JointType> joint_;
    List<LocalPiece> pieces_;
    Fixed<1> mass_, inverse_mass_, length_;
    Fixed<6> inertia_;
    Fixed<3> r1_, r2_;
    Fixed<4> joint_frame_, principal_axes_;
    Fixed<3> principal_moment_;
};

}  // namespace catena
