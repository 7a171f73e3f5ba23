// Trajectories in the DCD format of CHARMM, NAMD and VMD.
#pragma once

#include <cstdint>

#include "analysis/chosen_frames.hpp"

namespace catena::analysis {

/// Contents of a DCD file that was written.
struct DcdWritten {
    std::size_t frames = 0, sites = 0;
    std::int64_t first_step = 0, interval = 0;  // steps
    double time_step = 0;                       // ps per step
    std::size_t left_out = 0;                   // frames between multiples of the interval
};

/// Writes frames as DCD: single precision, Angstrom, little-endian, with the box in each frame. The
/// file appears under its name only when it is complete. A DCD file holds one interval between
/// frames; frames between its multiples are left out. Throws InputError for a gap in the frames,
/// for `units: si`, for wrapping without a box and for steps beyond the 32 bits of the format.
DcdWritten write_dcd(TrajectoryFile const&, ChosenFrames const&);

}  // namespace catena::analysis
