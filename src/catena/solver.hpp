// Solver: accelerations and joint forces of a model at its start.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "catena/forces.hpp"
#include "catena/scene.hpp"

namespace catena {

/// Result of Solver::solve(). Entries are bodies and beads, in the order of the scene.
struct SolverResult {
    /// Accelerations of all joint coordinates, body after body (see coordinates_of()).
    std::vector<double> joint_acceleration;
    /// First entry of each body in `joint_acceleration`, then the number of entries.
    std::vector<std::int64_t> first;
    /// Acceleration of the centre of mass or bead, W.
    std::vector<Triple> acceleration;
    /// Angular acceleration, W; zero for beads.
    std::vector<Triple> angular_acceleration;
    /// Constraint force on each body at its inboard joint or link.
    std::vector<JointForce> joint_force;
    /// Constraint forces of jointed tips and rings on the last bodies, one per such chain.
    std::vector<JointForce> tip_force;
    /// Constraint forces of loops on the first of their two bodies, one per loop.
    std::vector<JointForce> loop_force;
    /// Largest local residual of the equations of motion, and its bound by rounding.
    double residual = 0, residual_bound = 0;
    /// Estimated error relative to the largest acceleration; absent for beads, bodies on links and
    /// very many bodies. A result is not valid above `error_bound`.
    std::optional<double> error;
    double error_bound = 0;

    /// Accelerations of the coordinates of a body's inboard joint: revolute 1, spherical 3 (B),
    /// free 6 (angular in B, then the origin's in W), bead 3 (W).
    std::span<double const> coordinates_of(std::size_t body) const {
        return std::span(joint_acceleration)
            .subspan(static_cast<std::size_t>(first[body]),
                     static_cast<std::size_t>(first[body + 1] - first[body]));
    }
    /// True if the residual and the estimated error are within their bounds.
    bool valid() const { return residual <= residual_bound && (!error || *error <= error_bound); }
};

/// Computes accelerations by the divide-and-conquer algorithm, in joint coordinates.
class Solver {
  public:
    /// Prepares the model's start. Throws Error if the model is wrong, or if it combines an own
    /// force with a GPU, or with OpenMM's forces on rigid bodies.
    explicit Solver(Model const& model, OwnForce force = {});
    ~Solver();
    Solver(Solver&&) noexcept;
    Solver& operator=(Solver&&) noexcept;

    /// Solves at the start. Throws Error if a joint's matrix is singular.
    SolverResult solve();

  private:
    class Content;
    std::unique_ptr<Content> content_;
};

}  // namespace catena
