// What joints leave free and what they restrict.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "scene/scene.hpp"

namespace catena::scene {

/// Coordinates of a joint that is not driven: 1, universal 2, spherical 3, free 6; weld 0. A link
/// restricts one direction of six.
int coordinates_of(JointType type);

/// Whether the joints' axes are all parallel whatever the coordinates: revolute joints, the tip's
/// too, with welds between them or a free joint 1. `first_odd` receives the first body (from 0)
/// whose joint has no axis or one not parallel to those before; the size: the tip.
bool axes_are_parallel(ChainSpec const& chain, std::size_t& first_odd);

/// Whether joint `body` (from 0) has a spring or a damper.
bool resists(BodyArrays const& bodies, std::size_t body);
/// Whether some joint has.
bool resists(ChainSpec const& chain);

/// Of the inertias that an implicit integrator gives joint `body` along its coordinates
/// (rotor_of_spring()), the least and the largest. Somewhere none, elsewhere one, is no definite
/// matrix in the joint's axes, and of very different ones the smaller would be rounding.
struct ImplicitInertias {
    static constexpr double widest = 1e10;
    double least = 0, most = 0;
    bool are_definite() const { return least > 0; }
    bool are_alike() const { return most <= widest * least; }
};
ImplicitInertias implicit_inertias(BodyArrays const& bodies, std::size_t body,
                                   DynamicsSpec const& dynamics);

/// The smallest kind of handle that holds all joints of the chain.
enum class HandleKind : std::uint8_t { link, planar, spherical, universal, revolute, full };
HandleKind handle_kind(ChainSpec const& chain);
/// Directions that a handle of the kind carries: 1, 2, 3, 4, 5, 6.
int directions_of(HandleKind kind);
char const* name_of(HandleKind kind);

/// Whether Handles::articulated hold it, in joint coordinates: an open chain of rigid bodies.
bool takes_articulated_handles(ChainSpec const& chain);

/// Coordinates of the joints, those that are driven left out, less what the tip's joint restricts;
/// links: 6 a rigid body, 3 a bead, less one a link.
std::int64_t degrees_of_freedom(ChainSpec const& chain);

/// The first joint, from 0, that absolute coordinates do not hold (they hold links and spherical
/// joints); the size: the tip's; nothing: there is none.
std::optional<std::pair<std::size_t, JointType>> joint_without_absolute_coordinates(
    ChainSpec const& chain);

}  // namespace catena::scene
