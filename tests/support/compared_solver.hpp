// Solvers that must leave the same bits, on the very same inputs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dca/solver.hpp"

namespace catena::test {

struct NamedSolver {
    std::string name;
    std::unique_ptr<ChainSolver> solver;
};

/// Answers as `reference` does, and expects that the others answer with the same bits and refuse
/// with the same words.
std::unique_ptr<ChainSolver> compared_solver(ChainGroup const&,
                                             std::unique_ptr<ChainSolver> reference,
                                             std::vector<NamedSolver> others);

/// One evaluation of a group by such a solver, and then, where `at_once`, one that takes matrices
/// and biases together. A matrix that is not positive definite is no failure. Collective.
void evaluate_compared(ChainGroup const&, Scene const&, Executor const&, Communicator const&,
                       std::unique_ptr<ChainSolver> compared, bool at_once);

}  // namespace catena::test
