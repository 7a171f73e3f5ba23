// Solver of chains of point beads with cross-links: the Schur complement of the cross-links on top
// of the solver of the chains without them (src/dca/README.md, "Cross-links").
#pragma once

#include "dca/solver.hpp"
#include "math/semidefinite.hpp"

namespace catena::dca {

/// Keeps the matrices of the chains' solver and, per chain, the factor of one small system. After
/// the matrix sweep it makes a bias sweep for each cross-link of the chain that has most. Each
/// solution takes two bias sweeps.
class CrossLinkedSolver final : public ChainSolver {
  public:
    /// `tree` solves the chains without their cross-links. Group and executor must outlive the
    /// solver.
    CrossLinkedSolver(ChainGroup const& group, Executor const& executor,
                      std::unique_ptr<ChainSolver> tree);

    /// Throws ComputationError if the system of a chain's cross-links is indefinite.
    void assemble_matrices(ConfigurationView const&) override;
    void solve(LoadsView const&, AccelerationsView const&) override;
    void check() override { tree_->check(); }
    void wait() override { tree_->wait(); }
    void measure(bool on) override { tree_->measure(on); }
    SolverReport report() const override;

    /// Largest number of cross-links of a chain.
    std::int64_t rounds() const { return rounds_; }
    /// Cross-links of one chain of the group: entries [first, end) of Branching::crosslinks.
    struct Links {
        std::size_t first = 0, end = 0;
        SemidefiniteSystem system = {};
    };
    std::vector<Links> const& links() const { return links_; }
    /// Solves the chains without their cross-links under a unit pair of forces at cross-link
    /// `round` of every chain that has so many.
    void respond(std::int64_t round, AccelerationsView const&);

  private:
    Vec3 direction(std::size_t crosslink) const {
        return direction_.load(group_.first_crosslink() + static_cast<std::int64_t>(crosslink));
    }
    /// Returns the relative acceleration of a cross-link's ends along it.
    double apart(std::size_t crosslink) const;
    /// Adds a pair of forces along a cross-link, on its outboard bead and against it.
    void push(std::size_t crosslink, double force);
    /// Returns the response of a cross-link's two beads, alone and free, to a unit pair of forces.
    double free_response(std::size_t crosslink) const;
    [[noreturn]] void refuse(Links const&) const;

    ChainGroup const& group_;
    Executor const& executor_;
    std::unique_ptr<ChainSolver> tree_;
    std::vector<Links> links_;
    std::vector<Eigen::MatrixXd> matrices_;
    std::int64_t rounds_ = 0;
    ConstView<3> direction_;
    Field<3> force_, acceleration_;
    /// Seconds for the systems of cross-links, and the part of bias sweeps in them.
    double of_matrices_ = 0, swept_for_matrices_ = 0;
};

}  // namespace catena::dca
