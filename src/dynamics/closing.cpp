// The stopping rule of further sweeps.
#include "dynamics/closing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "dynamics/stays_open.hpp"

namespace catena {

std::string closing_error(double error) {
    if (!std::isfinite(error)) return "positions are no longer finite";
    std::ostringstream text;
    text << "error " << error;
    return text.str();
}

namespace {

// Number of consecutive sweeps that do not halve the error, after which a small error counts as
// rounding.
constexpr int in_vain_at_rounding = 5;

[[noreturn]] void fail(int sweeps, double error, double tolerance) {
    std::ostringstream line;
    line << "the joints do not close to dynamics.constraint_tolerance = " << tolerance << " within "
         << sweeps << " sweeps (" << closing_error(error)
         << "): the step is too long for how fast bodies move here: choose a smaller "
            "dynamics.step, or look at the start and the forces";
    throw ClosingFailure(line.str());
}

}  // namespace

int Closing::close(int done, std::function<double()> const& error,
                   std::function<void()> const& sweep) const {
    double open = error(), best = std::numeric_limits<double>::infinity();
    if (open <= tolerance) return 0;
    int more = 0, in_vain = 0;
    while (!(open <= enough)) {
        in_vain = open > 0.5 * best ? in_vain + 1 : 0;
        best = std::min(best, open);
        if (in_vain > 0 && open <= tolerance) return more;
        // Coordinates are far from the origin; the run's verdict reports the error.
        if (in_vain >= in_vain_at_rounding && open <= rounding) return more;
        if (!std::isfinite(open) || (done + more >= most && more >= in_vain_at_rounding)) {
            if (open <= tolerance) return more;
            fail(done + more, open, tolerance);
        }
        sweep();
        ++more;
        open = error();
    }
    return more;
}

}  // namespace catena
