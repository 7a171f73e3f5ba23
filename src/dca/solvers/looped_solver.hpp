// Solver of chains of rigid bodies with loops: the Schur complement of the joints that close them,
// on top of the solver of the open chains (src/dca/README.md, "Loops").
#pragma once

#include "dca/joint_directions.hpp"
#include "dca/solver.hpp"
#include "math/semidefinite.hpp"

namespace catena::dca {

/// Keeps the matrices of the open chains' solver and, per chain, the factor of one small system.
/// After the matrix sweep it makes a bias sweep for each restricted direction of the chain whose
/// loops restrict most. Each solution takes two bias sweeps, or up to
/// four where digits would be lost. Redundant directions get the least
/// forces, in the metric of the responses of single bodies; contradictory ones stay open.
class LoopedSolver final : public ChainSolver {
  public:
    /// `open` solves the chains without their loops. The group must outlive the solver.
    LoopedSolver(ChainGroup const& group, std::unique_ptr<ChainSolver> open);

    /// Throws ComputationError if the system of a chain's loops is indefinite.
    void assemble_matrices(ConfigurationView const&) override;
    void solve(LoadsView const&, AccelerationsView const&) override;
    void check() override { open_->check(); }
    void wait() override { open_->wait(); }
    void measure(bool on) override { open_->measure(on); }
    SolverReport report() const override;

  private:
    /// Loops of one chain of the group: entries [first, end) of LocalLoops::own, and the first of
    /// their restricted directions.
    struct Chain {
        std::size_t first = 0, end = 0;
        Eigen::MatrixXd matrix = {};
        SemidefiniteSystem system = {};
        /// Scale of each direction: the response of its two bodies, alone and free, to the power
        /// -1/2. Size of the last solution's scaled openings without the loops' forces.
        Eigen::VectorXd scale = {};
        double size = 0;
    };
    /// A restricted direction of a loop.
    struct Direction {
        std::size_t loop = 0;
        int number = 0;
    };
    /// Force and torque of a joint along its axes, on its outboard side.
    using Along = AlongAxes<double>;

    /// Accelerations of the bodies, B.
    struct Found {
        ConstView<3> alpha, acceleration;
    };

    std::vector<Direction> directions_of(Chain const&) const;
    /// Acceleration of one side of a joint along its axes; zero for the ground.
    Along side(std::int64_t body, LoopEnd const&, Found const&, ConstView<3> const& omega) const;
    /// Relative acceleration of a loop's two sides along its directions.
    Vector<double, 6> apart(std::size_t loop, Found const&, ConstView<3> const& omega) const;
    /// Relative accelerations, along all directions of a chain, that its loops still lack.
    Eigen::VectorXd open_directions(Chain const&, LoadsView const&, Found const&) const;
    /// Adds the forces that close a chain's loops to the loads.
    void add_forces(Chain const&, Eigen::VectorXd const& open);
    /// Adds the forces that close what rounding has left open; returns false if that is nothing.
    bool correct(LoadsView const&, Found const&);
    /// Adds a loop's force, along its directions, to the loads of its two bodies.
    void push(std::size_t loop, Vector<double, 6> const& force);
    /// Clears the loads of the two bodies of every loop.
    void release();
    /// Response of a loop's two bodies, alone and free, to a unit force along a direction.
    double free_response(Direction const&) const;
    /// Solves the open chains under a unit force along direction `round` of every chain that has so
    /// many.
    void respond(Eigen::Index round);
    void factorize(Chain&);
    /// Copies a load of the bodies, or clears it.
    void take(ConstView<3> const& given, Field<3>& to);
    [[noreturn]] void refuse(Chain const&) const;

    ChainGroup const& group_;
    std::unique_ptr<ChainSolver> open_;
    std::vector<Chain> chains_;
    Eigen::Index rounds_ = 0;
    LoopEnds const* ends_ = nullptr;
    Field<3> torque_, force_, alpha_, acceleration_;
    /// Forces of loops along their directions.
    std::vector<Vector<double, 6>> components_;
    /// Seconds for the systems of loops, and the part of bias sweeps in them.
    double of_matrices_ = 0, swept_for_matrices_ = 0;
};

}  // namespace catena::dca
