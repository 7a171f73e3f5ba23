// Fixman potential of cross-linked chains of point beads (src/dca/README.md, "Cross-links").
#pragma once

#include <vector>

#include "dca/solvers/crosslinked_solver.hpp"
#include "dynamics/branched_fixman.hpp"

namespace catena {

/// Adds what the cross-links contribute to the potential of the chains without them:
/// 1/2 kT log det of the cross-links' systems. Precondition: no link is redundant.
class CrossLinkFixman final : public FixmanPotential {
  public:
    /// The arguments must outlive this object.
    CrossLinkFixman(ChainGroup const&, Scene const&, Executor const&, dca::CrossLinkedSolver&);
    /// Throws ComputationError where links have become redundant.
    void add_forces(ConfigurationView const&, View<3> force) override;
    std::vector<double> energy() const override;

  private:
    using Links = dca::CrossLinkedSolver::Links;
    /// Response of the chains to a unit pair of forces at a cross-link of each of them.
    struct Column {
        Field<3> acceleration;
        DirectionsField force;
    };
    /// Adds the force of a chain's links, given the inverse of the matrix of its cross-links.
    void add_chain(Links const&, Eigen::MatrixXd const& inverse, ConstView<3> direction,
                   View<3> force) const;
    /// Returns the response of a link's ends, summed over the cross-links with these weights.
    Vec3 apart(Eigen::VectorXd const& weight, std::int64_t from, std::int64_t to) const;

    ChainGroup const& group_;
    Executor const& executor_;
    dca::CrossLinkedSolver& solver_;
    double kt_;
    BranchedFixman without_;
    std::vector<Column> columns_;
    /// Energy of each chain's cross-links.
    std::vector<double> energy_;
};

}  // namespace catena
