// The device's solver behind views of the host: configuration and loads go up, accelerations and forces come back.
#include <chrono>

#include "cuda/device_solver.cuh"
#include "cuda/solver.hpp"

namespace catena::cuda {
namespace {

class TransferredSolver final : public ChainSolver {
  public:
    TransferredSolver(ChainGroup const& group, Communicator const& communicator)
        : solver_(make_device_solver(group, space_, communicator)),
          direction_(group.beads || group.linked ? group.size : 0),
          tip_direction_(group.has_tips() ? group.size : 0),
          rotation_(group.beads ? 0 : group.size),
          moving_r2_(group.moving_meeting() ? group.size : 0),
          moving_axes2_(group.moving_meeting() ? group.size : 0),
          torque_(group.beads ? 0 : group.size),
          force_(group.size),
          omega_(group.beads ? 0 : group.size),
          bias_(group.size + 1, group.directions),
          tip_bias_(group.has_tips() ? group.size : 0, group.directions),
          alpha_(group.beads ? 0 : group.size),
          acceleration_(group.size),
          joint_force_(group.size + 1, group.directions),
          tip_force_(group.has_tips() ? group.size : 0, group.directions) {}

    void assemble_matrices(ConfigurationView const& c) override {
        auto const start = now();
        solver_->assemble_matrices(up(c));
        solver_->check();
        matrix_seconds_ += now() - start;
    }
    void assemble_and_solve(ConfigurationView const& configuration, LoadsView const& loads, AccelerationsView const& out) override {
        auto const start = now();
        solver_->assemble_and_solve(up(configuration), up(loads), wanted(out));
        bring_back(out);
        solver_->check();
        matrix_seconds_ += now() - start;
    }
    std::vector<double> time_evaluations(ConfigurationView const& configuration, LoadsView const& loads, AccelerationsView const& out,
                                         int chained, int repeat) override {
        return solver_->time_evaluations(up(configuration), up(loads), wanted(out), chained, repeat);
    }
    void solve(LoadsView const& l, AccelerationsView const& out) override {
        auto const start = now();
        solver_->solve(up(l), wanted(out));
        bring_back(out);
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
    ConfigurationView up(ConfigurationView const& c) const {
        ConfigurationView device;
        device.direction = up(c.direction, direction_);
        device.rotation = up(c.rotation, rotation_);
        device.tip_direction = up(c.tip_direction, tip_direction_);
        device.r2 = up(c.r2, moving_r2_);
        device.axes2 = up(c.axes2, moving_axes2_);
        return device;
    }
    LoadsView up(LoadsView const& l) const {
        LoadsView device;
        device.torque = up(l.torque, torque_);
        device.force = up(l.force, force_);
        device.omega = up(l.omega, omega_);
        device.bias = up(l.bias, bias_);
        device.tip_bias = up(l.tip_bias, tip_bias_);
        device.gyroscopic = l.gyroscopic;
        return device;
    }
    AccelerationsView wanted(AccelerationsView const& out) const {
        return {wanted(out.alpha, alpha_), wanted(out.acceleration, acceleration_), wanted(out.joint_force, joint_force_),
                wanted(out.tip_force, tip_force_)};
    }
    void bring_back(AccelerationsView const& out) const {
        alpha_.download(out.alpha, space_.stream());
        acceleration_.download(out.acceleration, space_.stream());
        joint_force_.download(out.joint_force, space_.stream());
        tip_force_.download(out.tip_force, space_.stream());
        space_.wait();
    }
    template <int D>
    ConstView<D> up(ConstView<D> const& host, DeviceField<D> const& device) const {
        device.upload(host, space_.stream());
        return host.origin ? ConstView<D>(device.view()) : ConstView<D>{};
    }
    ConstDirectionsView up(ConstDirectionsView const& host, DeviceDirections const& device) const {
        device.upload(host, space_.stream());
        return host ? ConstDirectionsView(device.view()) : ConstDirectionsView{};
    }
    template <class HostView, class Device>
    static HostView wanted(HostView const& host, Device const& device) {
        return host.origin ? device.view() : HostView{};
    }

    DeviceSpace space_;
    std::unique_ptr<ChainSolver> solver_;
    DeviceField<3> direction_, tip_direction_;
    DeviceField<4> rotation_;
    DeviceField<3> moving_r2_;
    DeviceField<9> moving_axes2_;
    DeviceField<3> torque_, force_, omega_;
    DeviceDirections bias_, tip_bias_;
    DeviceField<3> alpha_, acceleration_;
    DeviceDirections joint_force_, tip_force_;
    double matrix_seconds_ = 0, bias_seconds_ = 0;
};

}  // namespace

std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const& group, Communicator const& communicator) {
    return std::make_unique<TransferredSolver>(group, communicator);
}

}  // namespace catena::cuda
