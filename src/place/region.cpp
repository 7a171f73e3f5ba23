// Implements the reader of `place` and the words for regions.
#include "place/region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "keys/maps.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

namespace {

constexpr std::string_view axis_name = "xyz";

/// Reads `slab: {axis: z, thickness: 20}`.
Region read_slab(Node const& slab, Vec3 const& box) {
    Fields const fields(slab, keys::slab);
    Region region = whole_box(box);
    Node const* const axis = fields.find("axis");
    region.slab = axis ? choice<int>(*axis, {{"x", 0}, {"y", 1}, {"z", 2}}) : 2;
    Node const& given = fields.need("thickness", "thickness: 20");
    double const thickness = positive(given), edge = box[region.slab];
    if (thickness > edge)
        fail(given,
             fmt::format("the slab is {:.6g} nm thick, the box's edge along {} only {:.6g} nm",
                         thickness, axis_name[static_cast<std::size_t>(region.slab)], edge),
             fmt::format("give {:.6g} or less, or a longer box", edge));
    region.walled[static_cast<std::size_t>(region.slab)] = thickness < edge;
    return with_thickness(region, thickness);
}

/// Reads `region: {from: [...], to: [...]}`.
Region read_corners(Node const& corners, Vec3 const& box) {
    Fields const fields(corners, keys::region);
    Node const &from = fields.need("from", "from: [0, 0, 10]"),
               &to = fields.need("to", "to: [20, 20, 30]");
    Region region = whole_box(box);
    region.low = vector3(from), region.high = vector3(to);
    for (int i = 0; i < 3; ++i) {
        char const axis = axis_name[static_cast<std::size_t>(i)];
        if (!(region.low[i] < region.high[i]))
            fail(to,
                 fmt::format("the region ends at {} {:.6g} and begins at {:.6g}", axis,
                             region.high[i], region.low[i]),
                 "give a corner beyond `from` along each axis");
        if (region.low[i] < 0 || region.high[i] > box[i])
            fail(
                region.low[i] < 0 ? from : to,
                fmt::format("the region reaches from {} {:.6g} to {:.6g}, the box from 0 to {:.6g}",
                            axis, region.low[i], region.high[i], box[i]),
                "give corners within the box");
        region.walled[static_cast<std::size_t>(i)] = region.low[i] > 0 || region.high[i] < box[i];
    }
    return region;
}

/// Rounds a length up to a tenth of a nanometre.
double rounded_up(double length) { return std::ceil(10 * length - 1e-9) / 10; }

}  // namespace

double Region::volume() const { return volume_of_spheres(0); }

double Region::volume_of_spheres(double width) const {
    double volume = 1;
    for (int i = 0; i < 3; ++i)
        volume *= extent()[i] + (walled[static_cast<std::size_t>(i)] ? width : 0);
    return volume;
}

std::string Region::name() const {
    if (!has_walls()) return "the box";
    std::string text = slab >= 0 ? "the slab" : "the region";
    for (int i = 0; i < 3; ++i)
        if (walled[static_cast<std::size_t>(i)])
            text += fmt::format(", {} from {:.6g} to {:.6g} nm",
                                axis_name[static_cast<std::size_t>(i)], low[i], high[i]);
    return text;
}

Region whole_box(Vec3 const& box) {
    Region region;
    region.high = box;
    return region;
}

Node const* place_of(Node const& entry) {
    if (Node const* const own = entry.find("place")) return own;
    Node const* root = &entry;
    while (root->parent) root = root->parent;
    return root->find("place");
}

Region read_region(Node const& place, std::optional<Vec3> const& box) {
    Fields const fields(place, keys::place);
    if (!box)
        fail(place, "`place` puts chains into a part of the periodic box, the scene has none",
             "add `box: {periodic: [20, 20, 60]}`");
    Node const* const slab = fields.find("slab");
    Node const* const corners = fields.find("region");
    if (slab && corners) fail(*corners, "both `slab` and `region`", "keep one of them");
    if (!slab && !corners)
        fail(place, "neither `slab` nor `region`",
             "add `slab: {axis: z, thickness: 20}`, or `region: {from: [0, 0, 0], to: [9, 9, 9]}`");
    Region region = slab ? read_slab(*slab, *box) : read_corners(*corners, *box);
    region.node = &place;
    return region;
}

Region region_of(Node const& entry, std::optional<Vec3> const& box) {
    Node const* const place = place_of(entry);
    return place ? read_region(*place, box) : whole_box(*box);
}

Region with_thickness(Region slab, double thickness) {
    double const middle = 0.5 * (slab.low[slab.slab] + slab.high[slab.slab]);
    slab.low[slab.slab] = middle - 0.5 * thickness;
    slab.high[slab.slab] = middle + 0.5 * thickness;
    return slab;
}

std::string advice_on_thickness(Region const& slab, Vec3 const& box, double thickness) {
    double const enough = rounded_up(thickness);
    if (enough <= box[slab.slab])
        return fmt::format("give `thickness: {:.6g}` or more, or lower the number of chains",
                           enough);
    return fmt::format(
        "lower the number of chains, or give a box with an edge of {:.6g} along {} and "
        "`thickness: {:.6g}`",
        enough, axis_name[static_cast<std::size_t>(slab.slab)], enough);
}

}  // namespace catena::scene
