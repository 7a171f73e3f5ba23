// A chain of a scene in the arrays of kernels.hpp, and the sweeps over it in the place of the
// library's solver: loads, kinematics, residuals and rates are the library's.
#pragma once

#include <memory>

#include "dca/simd/side_by_side.hpp"
#include "dca/solver.hpp"
#include "tests/bench/precision/kernels.hpp"

namespace catena::precision {

/// Of a group that is one whole chain with a free tip, all its joints of one kind; none: nullopt,
/// or of another length than `lanes` share.
std::optional<Joint> joint_of(ChainGroup const&);
bool fits(ChainGroup const&, int lanes);

class ChainInArrays {
  public:
    /// Precondition: joint_of(group), fits(group, kernels.lanes).
    ChainInArrays(ChainGroup const&, Kernels const&);
    void take(ConfigurationView const&);
    void take(LoadsView const&);
    void give(AccelerationsView const&) const;

    bool assemble() const { return kernels_.assemble(work_); }
    void solve() const { kernels_.solve(work_); }
    void find_defect() const { kernels_.find_defect(work_); }
    void correct() const { kernels_.correct(work_); }
    /// Matrices, a solution and so many steps of refinement.
    void evaluate(int refinements) const;
    /// Bytes a body that assemble() and solve() read and write, and that a step of refinement does.
    double bytes_of_evaluation() const;
    double bytes_of_refinement() const;

  private:
    double bytes(std::initializer_list<Array> once, std::initializer_list<Array> twice) const;
    int numbers(Array) const;
    template <class Number>
    void put(Array, std::int64_t row, std::int64_t lane, double const* values);
    /// Of body k; of all numbers behind the last body, 0.
    void put(Array, std::int64_t k, std::vector<double> const& values);
    Vector<double, 6> get(std::int64_t k, int first, int count) const;

    ChainGroup const& group_;
    Kernels kernels_;
    std::vector<dca::AlignedNumbers> memory_;
    Work work_;
};

/// Until begin() the library's own solver, then a ChainInArrays.
class StudiedSolver final : public ChainSolver {
  public:
    StudiedSolver(std::unique_ptr<ChainSolver> usual, ChainInArrays& chain)
        : usual_(std::move(usual)), chain_(chain) {}
    void begin() { begun_ = true; }
    void refine(int steps) { steps_ = steps; }
    /// ComputationError where a matrix is not positive definite.
    void assemble_matrices(ConfigurationView const&) override;
    void solve(LoadsView const&, AccelerationsView const&) override;
    SolverReport report() const override { return usual_->report(); }

  private:
    std::unique_ptr<ChainSolver> usual_;
    ChainInArrays& chain_;
    bool begun_ = false;
    int steps_ = 0;
};

}  // namespace catena::precision
