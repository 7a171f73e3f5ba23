// Transfer of views and numbers between the host and a device, for levels that run on the GPU.
#pragma once

#include "chain/chain_group.hpp"
#include "cuda/space/device_space.cuh"

namespace catena::cuda {

/// Device copies of everything that a solver of levels reads and writes.
class DeviceCrossing {
  public:
    /// Allocates fields of the size of the group; those that its kind of chain lacks are empty.
    DeviceCrossing(ChainGroup const& group, DeviceSpace const& space)
        : space_(space),
          direction_(group.beads || group.linked ? group.size : 0),
          tip_direction_(group.ends.has_tips() ? group.size : 0),
          rotation_(group.beads ? 0 : group.size),
          moving_r2_(group.joints.moving_meeting() ? group.size : 0),
          moving_axes2_(group.joints.moving_meeting() ? group.size : 0),
          torque_(group.beads ? 0 : group.size),
          force_(group.size),
          omega_(group.beads ? 0 : group.size),
          bias_(group.size + 1, group.directions),
          tip_bias_(group.ends.has_tips() ? group.size : 0, group.directions),
          alpha_(group.beads ? 0 : group.size),
          acceleration_(group.size),
          joint_force_(group.size + 1, group.directions),
          tip_force_(group.ends.has_tips() ? group.size : 0, group.directions) {}

    /// Enqueues the copy of the configuration and returns the device's views.
    ConfigurationView take(ConfigurationView const& c) const {
        ConfigurationView device;
        device.direction = up(c.direction, direction_);
        device.rotation = up(c.rotation, rotation_);
        device.tip_direction = up(c.tip_direction, tip_direction_);
        device.r2 = up(c.r2, moving_r2_);
        device.axes2 = up(c.axes2, moving_axes2_);
        return device;
    }
    /// Enqueues the copy of the loads and returns the device's views.
    LoadsView take(LoadsView const& l) const {
        LoadsView device;
        device.torque = up(l.torque, torque_);
        device.force = up(l.force, force_);
        device.omega = up(l.omega, omega_);
        device.bias = up(l.bias, bias_);
        device.tip_bias = up(l.tip_bias, tip_bias_);
        device.gyroscopic = l.gyroscopic;
        return device;
    }
    /// Returns the device's views of the results that the host requests.
    AccelerationsView wanted(AccelerationsView const& host) const {
        return {place(host.alpha, alpha_), place(host.acceleration, acceleration_),
                place(host.joint_force, joint_force_), place(host.tip_force, tip_force_)};
    }
    /// Copies the results to the host's views; complete when the call returns.
    void fetch(AccelerationsView const& host) const {
        alpha_.download(host.alpha, space_.stream());
        acceleration_.download(host.acceleration, space_.stream());
        joint_force_.download(host.joint_force, space_.stream());
        tip_force_.download(host.tip_force, space_.stream());
        space_.wait();
    }

    /// Copies numbers to the host; complete when the call returns.
    void download(Buffer<double> const& from, std::vector<double>& to) const {
        check(cudaMemcpyAsync(to.data(), from.data(), to.size() * sizeof(double),
                              cudaMemcpyDeviceToHost, space_.stream()),
              "return items");
        space_.wait();
    }
    /// Enqueues a copy of numbers from the host.
    void upload(std::vector<double> const& from, Buffer<double> const& to) const {
        check(cudaMemcpyAsync(to.data(), from.data(), from.size() * sizeof(double),
                              cudaMemcpyHostToDevice, space_.stream()),
              "receive items");
    }

  private:
    /// Enqueues the copy of one field; returns an empty view if the host has none.
    template <int D>
    ConstView<D> up(ConstView<D> const& host, DeviceField<D> const& device) const {
        device.upload(host, space_.stream());
        return host.origin ? ConstView<D>(device.view()) : ConstView<D>{};
    }
    ConstDirectionsView up(ConstDirectionsView const& host, DeviceDirections const& device) const {
        device.upload(host, space_.stream());
        return host ? ConstDirectionsView(device.view()) : ConstDirectionsView{};
    }
    /// Returns the device's view if the host requests the result.
    template <class HostView, class Device>
    static HostView place(HostView const& host, Device const& device) {
        return host.origin ? device.view() : HostView{};
    }

    /// Space whose stream performs the copies.
    DeviceSpace space_;
    /// Configuration: directions of links, rotations, and moving handles of universal and screw
    /// joints.
    DeviceField<3> direction_, tip_direction_;
    DeviceField<4> rotation_;
    DeviceField<3> moving_r2_;
    DeviceField<6> moving_axes2_;
    /// Loads: torques, forces, angular velocities, and velocity terms of joints and tips.
    DeviceField<3> torque_, force_, omega_;
    DeviceDirections bias_, tip_bias_;
    /// Results: accelerations of bodies, and forces at joints and tips.
    DeviceField<3> alpha_, acceleration_;
    DeviceDirections joint_force_, tip_force_;
};

}  // namespace catena::cuda
