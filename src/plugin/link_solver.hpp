// Distance constraints between particles, solved by the divide-and-conquer algorithm for positions
// and velocities in arrays of the caller.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "plugin/constraint_chains.hpp"

namespace catena::plugin {

/// Solver of distance constraints. Positions are in nm, velocities in nm/ps, one Vec3 for each
/// particle; those without constraints are left alone.
class LinkSolver {
  public:
    virtual ~LinkSolver() = default;
    /// Moves particles from `to` onto the constraints by impulses along the constraints' directions
    /// at `from`, inversely to their masses: the equations of SHAKE. Relative errors end below
    /// 1e-12 or at rounding, and at most at `tolerance`. Throws ComputationError otherwise, and if
    /// positions are not finite; `to` is then unchanged.
    virtual void close(std::span<Vec3 const> from, std::span<Vec3> to, double tolerance) = 0;
    /// Does what close() does, with directions at the positions themselves, which may be far from
    /// the constraints.
    virtual void restore(std::span<Vec3> positions, double tolerance) = 0;
    /// Removes velocities along the constraints at `positions`: the equations of RATTLE. Throws
    /// ComputationError if the results are not finite.
    virtual void project(std::span<Vec3 const> positions, std::span<Vec3> velocities) = 0;
};

/// Returns the solver of constraints, on at most `threads` threads. The results do not depend on
/// their number. Exceptions: constraint_chains().
std::unique_ptr<LinkSolver> make_link_solver(std::vector<double> const& mass,
                                             std::vector<Constraint> const& constraints,
                                             int threads);

}  // namespace catena::plugin
