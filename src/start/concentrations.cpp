// Implements the concentrations of a start, from masses, positions and the box alone.
#include "start/concentrations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "generate/outline.hpp"
#include "place/concentration.hpp"
#include "scene/alike_chains.hpp"

namespace catena {
namespace {

/// Part of an edge that is free of beads beside a slab or another region.
double constexpr least_gap = 1. / 3;
/// Number of chains whose outermost beads tell the sides of their region.
std::ptrdiff_t constexpr least_chains = 20;

/// Part of the box that is not empty, along one axis.
struct Occupied {
    double from = 0, length = 0;
};

/// Returns the part of the axis that holds all coordinates: all but the longest gap between them.
Occupied occupied_of(std::vector<double> at, double edge) {
    for (double& x : at) x -= edge * std::floor(x / edge);
    std::sort(at.begin(), at.end());
    Occupied found{at.front(), at.back() - at.front()};
    for (std::size_t k = 1; k < at.size(); ++k)
        if (double const length = edge - (at[k] - at[k - 1]); length < found.length)
            found = {at[k], length};
    return found;
}

/// The same chains in the part of the box that they are in; no text if that is the whole box.
ChainConcentration in_part(ChainConcentration found, std::span<ChainSpec const> chains,
                           Vec3 const& box) {
    found.where.clear();
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> at;
        for (ChainSpec const& chain : chains)
            for (Vec3 const& point : scene::outline_of(chain).points) at.push_back(point[axis]);
        Occupied const part = occupied_of(std::move(at), box[axis]);
        if (part.length > (1 - least_gap) * box[axis] || part.length <= 0) continue;
        found.where += fmt::format("{}{} from {:.2f} to {:.2f} nm", found.where.empty() ? "" : ", ",
                                   "xyz"[axis], part.from, part.from + part.length);
        found.mg_per_ml *= box[axis] / part.length;
        found.mmol_per_l *= box[axis] / part.length;
    }
    return found;
}

ChainConcentration in_box(std::string name, std::span<ChainSpec const> chains, Vec3 const& box) {
    double mass = 0;
    for (ChainSpec const& chain : chains) mass += scene::mass_of(chain);
    double const volume = box[0] * box[1] * box[2];
    return {std::move(name), std::ssize(chains), "the box", scene::mg_per_ml_of(mass, volume),
            scene::mmol_per_l_of(static_cast<double>(chains.size()), volume)};
}

}  // namespace

std::string ChainConcentration::text() const {
    std::string const named = chains == "all chains" ? "" : " (" + chains + ")";
    return fmt::format("{} {}{} in {}: {:.5g} mg/ml, {:.5g} mmol/l", count,
                       count == 1 ? "chain" : "chains", named, where, mg_per_ml, mmol_per_l);
}

std::vector<ChainConcentration> concentrations_of(Scene const& scene) {
    std::vector<ChainConcentration> found;
    std::vector<scene::AlikeChains> const kinds = scene::alike_chains(scene);
    bool const several = std::any_of(kinds.begin(), kinds.end(),
                                     [](scene::AlikeChains const& kind) { return kind.count > 1; });
    if (!scene.box || scene.si || !several) return found;
    for (auto const& [first, count] : kinds) {
        auto const chains = std::span(scene.chains).subspan(first, count);
        std::string const begin = chains.front().name, end = chains.back().name;
        found.push_back(in_box(count == 1 ? begin : begin + " .. " + end, chains, *scene.box));
        if (std::ssize(chains) < least_chains) continue;
        ChainConcentration part = in_part(found.back(), chains, *scene.box);
        if (!part.where.empty()) found.push_back(std::move(part));
    }
    if (kinds.size() > 1) found.push_back(in_box("all chains", scene.chains, *scene.box));
    return found;
}

}  // namespace catena
