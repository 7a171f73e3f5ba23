// Runs integrators in joint coordinates from their programs.
#include "integrate/joint_program.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

bool has(std::span<JointOperation const> operations, JointOperator what) {
    return std::any_of(operations.begin(), operations.end(),
                       [&](JointOperation const& op) { return op.what == what; });
}

/// JointIntegrator of make_program().
class ProgramIntegrator final : public JointIntegrator {
  public:
    ProgramIntegrator(ChainSystem& system, JointProgram const& program,
                      JointThermostat const& thermostat)
        : system_(system), program_(program), thermostat_(thermostat) {
        if (has(program.step, JointOperator::evaluate_again)) system.keep_matrices();
    }
    void set_origin(double time) override { origin_ = time; }
    bool carries_rates() const override { return program_.saves(); }
    void restored(Checkpoint const&) override { first_ = {}; }
    void prepare() override {
        if (!program_.saves()) return;
        if (first_.empty()) return make_ghosts(system_);
        run(first_, 0);
        first_ = {};
    }
    void step(double h) override {
        prepare();
        run(program_.step, h);
    }

  private:
    void run(std::span<JointOperation const> operations, double h) {
        // Noise is keyed by the number of the step, which the time at its start tells.
        std::vector<JointDynamics*> const groups = system_.joint();
        double const start = groups.empty() ? 0.0 : groups.front()->time();
        for (JointOperation const& op : operations) {
            if (op.what == JointOperator::evaluate) {
                system_.solve_joint_groups();
            } else if (op.what == JointOperator::evaluate_again) {
                system_.solve_joint_groups_again();
            } else {
                JointOperation const numbered =
                    op.what == JointOperator::noise ? with_noise(op, start, h) : op;
                for (JointDynamics* const group : groups) group->apply(numbered, h);
            }
        }
    }
    JointOperation with_noise(JointOperation op, double start, double h) const {
        op.thermostat =
            thermostat_of(std::exp(-thermostat_.friction * h), thermostat_.kt, thermostat_.seed);
        op.number = static_cast<std::uint64_t>(std::llround((start - origin_) / h));
        return op;
    }

    ChainSystem& system_;
    JointProgram program_;
    JointThermostat thermostat_;
    double origin_ = 0;
    /// Operations before the first step that are still to be done.
    std::span<JointOperation const> first_ = program_.prepare;
};

}  // namespace

SweepsAStep JointProgram::sweeps() const {
    SweepsAStep sum{0, 0};
    for (JointOperation const& op : step) {
        bool const assembles =
            op.what == JointOperator::evaluate || op.what == JointOperator::noise;
        sum.matrices += assembles;
        sum.biases += assembles || op.what == JointOperator::evaluate_again;
    }
    return sum;
}

std::unique_ptr<JointIntegrator> make_program(ChainSystem& system, JointProgram const& program,
                                              JointThermostat const& thermostat) {
    return std::make_unique<ProgramIntegrator>(system, program, thermostat);
}

}  // namespace catena
