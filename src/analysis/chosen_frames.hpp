// Frames of a trajectory that another format shall hold, and the places of their sites.
#pragma once

#include <cstdint>
#include <string>

#include "frames/trajectory_file.hpp"

namespace catena::analysis {

/// Place at which the sites of a periodic box are written.
enum class Wrap {
    none,    // positions of the trajectory: chains are whole and unwrapped
    chains,  // chains are whole, the mean position of each lies in the box
    sites    // every site lies in the box; chains are cut at its faces
};

/// Request for a file of frames.
struct ChosenFrames {
    std::string file;
    Wrap wrap = Wrap::none;
    std::size_t first = 0, last = SIZE_MAX;  // frames, both included

    /// Returns the frame after the last one.
    std::size_t end(TrajectoryFile const&) const;
};

/// Throws InputError for frames that are not there and for wrapping without a box.
void require_frames(TrajectoryFile const&, ChosenFrames const&);

/// Moves the sites of a frame to the places that were asked for, by whole edges of the box.
void wrap(Snapshot&, Topology const&, Wrap);

}  // namespace catena::analysis
