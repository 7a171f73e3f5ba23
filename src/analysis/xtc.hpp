// Trajectories in the XTC format of GROMACS.
#pragma once

#include <cstdint>

#include "analysis/chosen_frames.hpp"

namespace catena::analysis {

/// Positions per nm that an XTC file tells apart, unless a request names another number.
constexpr double usual_precision = 1000;

/// Contents of an XTC file that was written.
struct XtcWritten {
    std::size_t frames = 0, sites = 0;
    std::int64_t first_step = 0, last_step = 0;
    std::uint64_t bytes = 0;
};

/// Writes frames as XTC: positions in nm, rounded to 1 / `precision`, with step, time in ps and box
/// of each frame. Up to 9 sites are not rounded, because the format does not compress them. The
/// file appears under its name only when it is complete. Throws InputError for frames that are not
/// there, for `units: si`, for wrapping without a box, for steps beyond the 32 bits of the format
/// and for positions beyond the range of its integers.
XtcWritten write_xtc(TrajectoryFile const&, ChosenFrames const&,
                     double precision = usual_precision);

}  // namespace catena::analysis
