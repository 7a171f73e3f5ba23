// One frame of another run: what a scene may start from.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/output.hpp"

namespace catena {

/// A frame and what its trajectory says of the chains.
struct ChosenFrame {
    std::string file;                     // the trajectory
    std::size_t frame = 0, frames = 0;    // number of the frame, from 0, and of all frames
    std::optional<std::int64_t> step;     // none in a DCD file
    double time = 0;                      // ps; 0 without a step
    std::vector<Vec3> position;           // per site, nm (m with `units: si`)
    std::optional<Vec3> box;              // edges of the periodic box
    std::vector<Topology::Chain> chains;  // empty: the file does not tell them apart
    std::vector<std::string> residue;     // per site; empty: unknown
    bool si = false;

    /// Returns for example "frame 56 of 0 to 99 (step 5600, 56 ps) of `run/trajectory.h5md`".
    std::string text() const;
};

/// Reads a frame of `place`: the folder of a run, an H5MD file of Catena, or a DCD file (`.dcd`).
/// Without a number it is the last frame. Throws InputError for a frame that is not there.
ChosenFrame read_frame(std::string const& place, std::optional<std::int64_t> frame);

}  // namespace catena
