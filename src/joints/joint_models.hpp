// The list of joint models, and what is asked of a joint type at run time. A new type is one file
// beside this one, an enumerator (joint_type.hpp) and an entry of JointModels.
#pragma once

#include <string_view>
#include <type_traits>

#include "joints/cylindrical.hpp"
#include "joints/free.hpp"
#include "joints/helical.hpp"
#include "joints/link.hpp"
#include "joints/planar3.hpp"
#include "joints/prismatic.hpp"
#include "joints/revolute.hpp"
#include "joints/spherical.hpp"
#include "joints/universal.hpp"
#include "joints/weld.hpp"

namespace catena {

/// List of types.
template <class... Types>
struct TypeList {};

/// All joint models, in the order in which messages name them and `mixed` random chains draw them.
using JointModels =
    TypeList<FreeJoint, LinkJoint, RevoluteJoint, UniversalJoint, SphericalJoint, PrismaticJoint,
             HelicalJoint, CylindricalJoint, Planar3Joint, WeldJoint>;
/// Motions of joints with axes; the last one is that of all types that the others do not take.
using AxisMotions =
    TypeList<UniversalMotion, RigidMotion, CylindricalMotion, PlanarMotion, ScrewMotion>;
/// Motions of all joints.
using JointMotions = TypeList<QuaternionMotion, UniversalMotion, RigidMotion, CylindricalMotion,
                              PlanarMotion, ScrewMotion>;

namespace joints {

/// True if the model of the type has the property: a fold of comparisons, without a table, for the
/// device.
template <class Property, class... Models>
CATENA_HD constexpr bool any_has(JointType type, Property property, TypeList<Models...>) {
    return ((property(Models{}) && type == Models::type) || ...);
}
/// Returns visitor(model) for the first model of that type, or for the last one of the list.
template <class Visitor, class First, class... Rest>
constexpr auto visit(JointType type, Visitor const& visitor, TypeList<First, Rest...>) {
    if constexpr (sizeof...(Rest) > 0)
        if (type != First::type) return visit(type, visitor, TypeList<Rest...>{});
    return visitor(First{});
}
/// True if the type has the motion `Wanted`.
template <class Wanted>
CATENA_HD constexpr bool has_motion(JointType type) {
    return any_has(
        type, [](auto model) { return std::is_same_v<typename decltype(model)::Motion, Wanted>; },
        JointModels{});
}
/// Returns visitor(motion) for the first motion that the type has, or for the last one of the list.
template <class Visitor, class First, class... Rest>
CATENA_HD constexpr auto visit_motion(JointType type, Visitor const& visitor,
                                      TypeList<First, Rest...>) {
    if constexpr (sizeof...(Rest) > 0)
        if (!has_motion<First>(type)) return visit_motion(type, visitor, TypeList<Rest...>{});
    return visitor(First{});
}
/// Calls visitor(model) for every model.
template <class Visitor, class... Models>
void for_each(Visitor const& visitor, TypeList<Models...>) {
    (visitor(Models{}), ...);
}

/// Calls visitor(model) for every model whose order of directions is its own, on host and device.
template <class Visitor, class... Models>
CATENA_HD constexpr void for_each_ordered(Visitor const& visitor, TypeList<Models...>) {
    static_assert(((Models::order == usual_order || direction_at(Models::order, 5) == 5) && ...));
    auto const visit_ordered = [&](auto model) {
        if constexpr (decltype(model)::order != usual_order) visitor(model);
    };
    (visit_ordered(Models{}), ...);
}

}  // namespace joints

/// Returns visitor(model) for the model of a type; all models give the same type of result.
template <class Visitor>
constexpr auto with_joint(JointType type, Visitor const& visitor) {
    return joints::visit(type, visitor, JointModels{});
}
/// Calls visitor(model) for every model, in the order of the list.
template <class Visitor>
void for_each_joint(Visitor const& visitor) {
    joints::for_each(visitor, JointModels{});
}
/// Returns visitor(motion) for the motion of a type, on host and device.
template <class Visitor>
CATENA_HD constexpr auto with_motion(JointType type, Visitor const& visitor) {
    return joints::visit_motion(type, visitor, JointMotions{});
}
/// Returns visitor(motion) for the motion of a type whose position is no quaternion.
template <class Visitor>
CATENA_HD constexpr auto with_axis_motion(JointType type, Visitor const& visitor) {
    return joints::visit_motion(type, visitor, AxisMotions{});
}

// Properties of a type, on host and device.

/// True if the position is a unit quaternion.
CATENA_HD constexpr bool has_quaternion(JointType type) {
    return joints::any_has(
        type, [](auto model) { return decltype(model)::quaternion; }, JointModels{});
}
/// True if the joint translates the outboard body.
CATENA_HD constexpr bool slides(JointType type) {
    return joints::any_has(type, [](auto model) { return decltype(model)::slides; }, JointModels{});
}
/// True for the joint of a free base.
CATENA_HD constexpr bool floats(JointType type) {
    return joints::any_has(type, [](auto model) { return decltype(model)::floats; }, JointModels{});
}
/// True for a link of fixed length.
CATENA_HD constexpr bool is_rod(JointType type) {
    return joints::any_has(type, [](auto model) { return decltype(model)::rod; }, JointModels{});
}
/// True for a rotation about every axis, with moments as vectors in B.
CATENA_HD constexpr bool is_ball(JointType type) {
    return joints::any_has(type, [](auto model) { return decltype(model)::ball; }, JointModels{});
}
/// True if the joint allows no motion.
CATENA_HD constexpr bool is_rigid(JointType type) {
    return joints::any_has(type, [](auto model) { return decltype(model)::rigid; }, JointModels{});
}
/// True for a rotation about one axis and nothing else.
CATENA_HD constexpr bool pivots(JointType type) {
    return joints::any_has(type, [](auto model) { return decltype(model)::pivots; }, JointModels{});
}
/// True if the joint translates along its first two axes.
CATENA_HD constexpr bool glides(JointType type) {
    return joints::any_has(type, [](auto model) { return decltype(model)::glides; }, JointModels{});
}
/// True if handles in this order belong to a joint that glides.
CATENA_HD constexpr bool glides_in(int order) {
    bool found = false;
    joints::for_each_ordered(
        [&](auto model) {
            found = found || (decltype(model)::glides && decltype(model)::order == order);
        },
        JointModels{});
    return found;
}
/// True if the joint rotates about two axes, of which each is fixed in one body.
CATENA_HD constexpr bool turns_twice(JointType type) {
    return joints::any_has(
        type, [](auto model) { return decltype(model)::turns_twice; }, JointModels{});
}
/// True if the joint's last axis is fixed in both bodies.
CATENA_HD constexpr bool keeps_axis(JointType type) {
    return joints::any_has(
        type, [](auto model) { return decltype(model)::axes > 0 && !decltype(model)::turns_twice; },
        JointModels{});
}
/// True if coordinate i is a length.
CATENA_HD constexpr bool is_length(JointType type, int i) {
    return joints::any_has(
        type, [i](auto model) { return (decltype(model)::lengths >> i & 1) != 0; }, JointModels{});
}
/// True if the joint has two coordinates.
CATENA_HD constexpr bool has_two_coordinates(JointType type) {
    return joints::any_has(
        type, [](auto model) { return decltype(model)::numbers == 2; }, JointModels{});
}
/// True if a scene gives the joint one axis.
CATENA_HD constexpr bool has_one_axis(JointType type) {
    return joints::any_has(
        type, [](auto model) { return decltype(model)::axes == 1; }, JointModels{});
}
/// True if a scene gives the joint two axes.
CATENA_HD constexpr bool has_two_axes(JointType type) {
    return joints::any_has(
        type, [](auto model) { return decltype(model)::axes == 2; }, JointModels{});
}

// Properties of a type on the host.

/// True if the joint slides by a pitch as it rotates.
constexpr bool has_pitch(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::pitched; });
}
/// True if some coordinates are lengths and others are angles.
constexpr bool mixes_units(JointType type) {
    return with_joint(type, [](auto model) {
        constexpr int lengths = decltype(model)::lengths;
        return lengths != 0 && lengths != (1 << decltype(model)::numbers) - 1;
    });
}
/// Order of the directions of the joint's handles.
constexpr int order_of(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::order; });
}
/// True if the solvers in absolute coordinates support the joint.
constexpr bool is_absolute(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::absolute; });
}
/// Degrees of freedom of a body on the joint.
constexpr int freedom_of(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::freedom; });
}
/// Number of directions that the joint restricts.
constexpr int restricted_by(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::restricted; });
}
/// Number of components of torque, stiffness and damping.
constexpr int numbers_of_joint(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::numbers; });
}
/// Number of components of qd.
constexpr int rates_of_joint(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::rates; });
}
/// Role of the joint in the plane of the bodies before it.
constexpr PlaneRole role_in_plane(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::plane; });
}
/// X(q) of the outboard body's frame in the joint frame.
inline JointDisplacement displacement_of(JointType type, JointShape const& shape,
                                         std::array<double, 4> const& q) {
    return with_joint(type, [&](auto model) { return decltype(model)::displacement(shape, q); });
}
/// Default position, at which X(q) is the identity.
constexpr std::array<double, 4> rest_position(JointType type) {
    return {has_quaternion(type) ? 1.0 : 0.0, 0, 0, 0};
}

}  // namespace catena
