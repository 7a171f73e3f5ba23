// Mean squared displacement of the chains' centres of mass, and their diffusion.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/fits.hpp"
#include "math/linear.hpp"

namespace catena::analysis {

/// Mean squared displacements of all copies of a chain.
struct Displacements {
    std::vector<double> lag;       // times between frames, in the unit of time
    std::vector<Estimate> square;  // <|x(t + lag) - x(t)|^2> over all t and copies
    Fitted diffusion;              // D of <|x|^2> = c + 6 D lag; `range` in the unit of time
};

/// Computes displacements from the centres of mass [frame][copy] of frames that are `interval`
/// apart. Positions are unwrapped in a trajectory of Catena, so that no image is taken. Lags are
/// all up to 128 frames and about 16 per doubling, up to half of the frames. D is the slope of a
/// straight line by least squares over lags of 5 % to 25 % of the whole time. Its error is that of
/// the mean over starting frames.
Displacements displacements_of(std::span<Vec3 const> centres, std::size_t copies, double interval);

}  // namespace catena::analysis
