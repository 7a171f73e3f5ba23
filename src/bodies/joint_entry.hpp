// Reader of one `joint: {...}`: its type, its axes and frame, and its loads.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bodies/physics.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// One joint as read, with defaults for the missing keys. The members are documented at BodyArrays.
struct JointEntry {
    JointType type = JointType::free;
    /// True if the type is written `planar`: a revolute joint in a chain of parallel axes.
    bool planar = false;
    /// Axes and joint frame, see BodyArrays.
    Vec3 axis = Vec3::zero(), first_axis = Vec3::zero(), translation = Vec3::zero();
    double pitch = 0;
    Mat3 rotation = Mat3::identity();
    /// Position and rest position, rates and loads, see BodyArrays.
    std::array<double, 4> q{0, 0, 0, 0}, rest{0, 0, 0, 0};
    Vec3 qd = Vec3::zero(), torque = Vec3::zero(), stiffness = Vec3::zero(), damping = Vec3::zero();
    /// Position and velocity of a free joint, W.
    Vec3 position = Vec3::zero(), velocity = Vec3::zero();
    /// Prescribed motion per coordinate; empty without prescribed motion.
    std::vector<PrescribedMotion> motion;
    bool loaded = false, sprung = false,
         /// True if the joint gives a torque (loaded), a stiffness or rest position (sprung), a
         /// damping (damped).
        damped = false;
};

/// Reads any joint but a link. Throws InputError for keys without meaning for the joint's type and
/// for invalid values.
JointEntry read_joint(Node const& joint);

/// Joint of a tip as read.
struct TipEntry {
    /// Joint in the form of the chain.
    TipJoint joint;
    /// True if the type is written `planar`.
    bool planar = false;
};
/// Reads the joint of `tip: {joint: ...}`: any type but free; a link needs its anchor. If `ring` is
/// set, reads that of `tip: {ring: ...}`, which has neither anchor nor q. Joints of rings other
/// than links need their translation.
TipEntry read_tip_joint(Node const& joint, bool ring);

/// Reads the joint of an entry of `loops`: any type but free, planar and link.
TipJoint read_loop_joint(Node const& joint);

/// Number of components of the joint's torque, stiffness or damping: 1, 2 or 3. It is 0 for links,
/// welds and free joints.
int numbers_of(JointType type);
/// Largest coordinate of a joint, in radians or the scene's lengths, and largest coordinate of
/// positions. A double resolves an angle of that size to 1e-7.
inline constexpr double farthest_coordinate = 1e9;
/// Returns a fault for a position of a joint with a coordinate beyond that.
std::optional<Fault> check_range(std::array<double, 4> const& q);
/// Returns a fault if a joint of this type cannot have these two unit axes; makes those of a
/// planar3 joint perpendicular to rounding.
std::optional<Fault> check_axes(JointType type, Vec3& first, Vec3 const& axis);

}  // namespace catena::scene
