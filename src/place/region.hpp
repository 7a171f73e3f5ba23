// Regions of the periodic box in which chains start: `place: {slab: ...}`, `place: {region: ...}`.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "math/linear.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Rectangular part of the periodic box. Walls bound it along some axes; along the others it is as
/// long as the box and as periodic.
struct Region {
    /// Coordinates of the walls; 0 and the box's edge along axes without walls.
    Vec3 low = Vec3::zero(), high = Vec3::zero();
    /// True for each axis that has walls.
    std::array<bool, 3> walled{};
    /// Axis across a slab, from 0; -1 for any other region.
    int slab = -1;
    /// The `place` that was read; nullptr for the whole box.
    Node const* node = nullptr;

    /// Returns the distance of the walls, or the box's edge.
    Vec3 extent() const { return high - low; }
    bool has_walls() const { return walled[0] || walled[1] || walled[2]; }
    double volume() const;
    /// Returns the volume in which spheres of the given width fit whose centres keep to the region.
    double volume_of_spheres(double width) const;
    /// Returns a name for messages, such as "the slab, z from 20 to 40 nm".
    std::string name() const;
};

/// The whole box as a region without walls.
Region whole_box(Vec3 const& box);

/// Returns the `place` of an entry in `chains`: its own, else the scene's, else nullptr.
Node const* place_of(Node const& entry);
/// Reads a slab in the middle of the box, or a region between two corners. Throws InputError for
/// one that does not lie in the box, and for a scene without a periodic box.
Region read_region(Node const& place, std::optional<Vec3> const& box);
/// Returns the region of an entry in `chains`; the whole box if no `place` applies. Precondition: a
/// box, or a `place` (which is refused without one).
Region region_of(Node const& entry, std::optional<Vec3> const& box);

/// Returns the slab with another thickness, around the same middle.
Region with_thickness(Region slab, double thickness);
/// Returns the advice for a slab that must be `thickness` thick to hold its chains. If the box is
/// too short for that, the advice names the edge that would do.
std::string advice_on_thickness(Region const& slab, Vec3 const& box, double thickness);

}  // namespace catena::scene
