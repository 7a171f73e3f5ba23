// Implements the choice of frames and the wrapping of sites.
#include "analysis/chosen_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "error.hpp"

namespace catena::analysis {
namespace {

void shift_into(Vec3 const& box, Vec3 const& place, std::span<Vec3> sites) {
    for (int i = 0; i < 3; ++i) {
        double const shift = box[i] * std::floor(place[i] / box[i]);
        for (Vec3& x : sites) x[i] -= shift;
    }
}

}  // namespace

std::size_t ChosenFrames::end(TrajectoryFile const& trajectory) const {
    return std::min(last, trajectory.steps().size() - 1) + 1;
}

void require_frames(TrajectoryFile const& trajectory, ChosenFrames const& chosen) {
    std::size_t const frames = trajectory.steps().size();
    if (chosen.first < frames && chosen.first > chosen.last)
        throw InputError(
            fmt::format("the last frame, {}, is before the first, {}", chosen.last, chosen.first),
            "--last", "frames count from 0: choose a later one");
    if (chosen.first >= frames)
        throw InputError(
            fmt::format("no frame from {} on, the trajectory has {}", chosen.first, frames),
            "--first", "frames count from 0: choose fewer");
    if (chosen.wrap != Wrap::none && !trajectory.topology().box)
        throw InputError("there is no periodic box to wrap into", trajectory.name(),
                         "leave --wrap out");
}

void wrap(Snapshot& snapshot, Topology const& topology, Wrap how) {
    if (how == Wrap::none) return;
    std::span<Vec3> const all = snapshot.position;
    for (Topology::Chain const& chain : topology.chains) {
        std::span<Vec3> const sites = all.subspan(static_cast<std::size_t>(chain.first),
                                                  static_cast<std::size_t>(chain.count));
        Vec3 middle = Vec3::zero();
        for (Vec3& x : sites) {
            if (how == Wrap::sites) shift_into(*snapshot.box, x, std::span(&x, 1));
            middle = plus_scaled(middle, 1 / static_cast<double>(chain.count), x);
        }
        if (how == Wrap::chains && chain.count > 0) shift_into(*snapshot.box, middle, sites);
    }
}

}  // namespace catena::analysis
