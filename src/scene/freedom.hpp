// Degrees of freedom that joints allow and directions that they restrict.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "scene/scene.hpp"

namespace catena::scene {

/// Number of coordinates of a joint without prescribed motion: 1, universal 2, spherical 3, free 6,
/// weld 0. A link has 5, for it restricts one direction of six.
int coordinates_of(JointType type);

/// True if the axes of all joints stay parallel for all coordinates. This holds for revolute
/// joints, the tip included, with welds between them or a free joint 1. `first_odd` receives the
/// first body (from 0) whose joint has no axis or one not parallel to the axes before it.
/// `first_odd` equals the number of bodies if the tip is that joint.
bool axes_are_parallel(ChainSpec const& chain, std::size_t& first_odd);

/// True if joint `body` (from 0) has a spring or a damper.
bool resists(BodyArrays const& bodies, std::size_t body);
/// True if any joint of the chain has a spring or a damper.
bool resists(ChainSpec const& chain);

/// Least and largest inertia that an implicit integrator adds along the coordinates of joint `body`
/// (rotor_of_spring()). Inertias that are zero along some coordinates only give no definite matrix
/// in the joint's axes. If they differ widely, the smaller one is lost to rounding.
struct ImplicitInertias {
    static constexpr double widest = 1e10;
    double least = 0, most = 0;
    bool are_definite() const { return least > 0; }
    bool are_alike() const { return most <= widest * least; }
};
/// Computes the added inertias h (c h K + C / 2) of joint `body` (from 0), with step h, stiffness K
/// and damping C.
ImplicitInertias implicit_inertias(BodyArrays const& bodies, std::size_t body,
                                   DynamicsSpec const& dynamics);

/// Smallest kind of handle that represents all joints of the chain.
enum class HandleKind : std::uint8_t { link, planar, spherical, universal, revolute, full };
HandleKind handle_kind(ChainSpec const& chain);
/// Number of directions that a handle of the kind carries: 1, 2, 3, 4, 5, 6.
int directions_of(HandleKind kind);
char const* name_of(HandleKind kind);

/// True if Handles::articulated supports the chain, in joint coordinates: an open chain of rigid
/// bodies.
bool takes_articulated_handles(ChainSpec const& chain);

/// Number of coordinates of the joints without prescribed motion, less the directions that the
/// tip's joint and loops restrict, redundant ones left out. Links: 6 per rigid body, 3 per bead,
/// less one per link that is not redundant (ChainSpec::redundant_links).
std::int64_t degrees_of_freedom(ChainSpec const& chain);

/// First joint (from 0) that absolute coordinates do not support; they support links and spherical
/// joints. Returns the number of bodies for the tip's joint, and nothing if all joints are
/// supported.
std::optional<std::pair<std::size_t, JointType>> joint_without_absolute_coordinates(
    ChainSpec const& chain);

}  // namespace catena::scene
