// Implements the choice of a frame.
#include "frames/chosen_frame.hpp"

#include <fmt/format.h>

#include "error.hpp"
#include "frames/dcd_file.hpp"
#include "frames/trajectory_file.hpp"

namespace catena {
namespace {

/// Returns the number of the wanted frame; throws InputError if there are fewer.
std::size_t chosen(std::optional<std::int64_t> frame, std::size_t frames, std::string const& file) {
    if (!frame) return frames - 1;
    if (*frame >= static_cast<std::int64_t>(frames))
        throw InputError(fmt::format("there is no frame {}, the trajectory has {}", *frame, frames),
                         file, fmt::format("give a frame from 0 to {}, or `last`", frames - 1));
    return static_cast<std::size_t>(*frame);
}

ChosenFrame from_dcd(std::string const& place, std::optional<std::int64_t> frame) {
    DcdFile const file(place);
    ChosenFrame found;
    found.file = file.name(), found.frames = file.frames();
    found.frame = chosen(frame, found.frames, found.file);
    Snapshot snapshot = file.read(found.frame);
    found.position = std::move(snapshot.position), found.box = snapshot.box;
    return found;
}

ChosenFrame from_run(std::string const& place, std::optional<std::int64_t> frame) {
    TrajectoryFile const file(place);
    ChosenFrame found;
    found.file = file.name(), found.frames = file.steps().size();
    found.frame = chosen(frame, found.frames, found.file);
    found.step = file.steps()[found.frame], found.time = file.times()[found.frame];
    found.chains = file.topology().chains, found.si = file.topology().si;
    if (file.has_residues()) found.residue = file.topology().residue;
    Snapshot snapshot;
    file.read(found.frame, snapshot);
    found.position = std::move(snapshot.position), found.box = snapshot.box;
    return found;
}

}  // namespace

std::string ChosenFrame::text() const {
    std::string const when =
        step ? fmt::format(" (step {}, {:.6g} {})", *step, time, si ? "s" : "ps") : "";
    return fmt::format("frame {} of 0 to {}{} of `{}`", frame, frames - 1, when, file);
}

ChosenFrame read_frame(std::string const& place, std::optional<std::int64_t> frame) {
    return place.ends_with(".dcd") || place.ends_with(".DCD") ? from_dcd(place, frame)
                                                              : from_run(place, frame);
}

}  // namespace catena
