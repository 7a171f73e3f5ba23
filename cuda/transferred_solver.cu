// The device's solver behind views of the host: configuration and loads go up, accelerations and forces come back.
#include <chrono>

#include "cuda/device_crossing.cuh"
#include "cuda/device_solver.cuh"
#include "cuda/solver.hpp"

namespace catena::cuda {
namespace {

class TransferredSolver final : public ChainSolver {
  public:
    TransferredSolver(ChainGroup const& group, Communicator const& communicator)
        : crossing_(group, space_), solver_(make_device_solver(group, space_, communicator)) {}

    void assemble_matrices(ConfigurationView const& configuration) override {
        auto const start = now();
        solver_->assemble_matrices(crossing_.take(configuration));
        solver_->check();
        matrix_seconds_ += now() - start;
    }
    void assemble_and_solve(ConfigurationView const& configuration, LoadsView const& loads, AccelerationsView const& out) override {
        auto const start = now();
        solver_->assemble_and_solve(crossing_.take(configuration), crossing_.take(loads), crossing_.wanted(out));
        crossing_.fetch(out);
        solver_->check();
        matrix_seconds_ += now() - start;
    }
    std::vector<double> time_evaluations(ConfigurationView const& configuration, LoadsView const& loads, AccelerationsView const& out,
                                         int chained, int repeat) override {
        return solver_->time_evaluations(crossing_.take(configuration), crossing_.take(loads), crossing_.wanted(out), chained, repeat);
    }
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        auto const start = now();
        solver_->solve(crossing_.take(loads), crossing_.wanted(out));
        crossing_.fetch(out);
        bias_seconds_ += now() - start;
    }
    SolverReport report() const override {
        SolverReport r = solver_->report();
        r.matrix_seconds = matrix_seconds_;
        r.bias_seconds = bias_seconds_;
        return r;
    }

  private:
    static double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

    DeviceSpace space_;
    DeviceCrossing crossing_;
    std::unique_ptr<ChainSolver> solver_;
    double matrix_seconds_ = 0, bias_seconds_ = 0;
};

}  // namespace

std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const& group, Communicator const& communicator) {
    return std::make_unique<TransferredSolver>(group, communicator);
}

}  // namespace catena::cuda
