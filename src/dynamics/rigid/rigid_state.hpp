// State of rigid bodies in absolute coordinates, and the velocities that observers see, in any
// Space.
#pragma once

#include "dca/host_space.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/rigid/rigid_start.hpp"

namespace catena {

/// Poses and velocities of bodies: position and velocity of the centre of mass (W), omega (B) and
/// orientation (quaternion of B in W).
struct RigidState {
    View<3> position, velocity, omega;
    View<4> orientation;

    /// Rotation matrix of B in W.
    CATENA_HD Mat3 axes(std::int64_t k) const {
        return to_matrix(as_quaternion(orientation.load(k)));
    }
};

/// Copies an array into a field over bodies in a Space.
template <int D, class Space, class FieldOfSpace>
void set_field(Space const& space, FieldOfSpace& field, StateArray const& array) {
    space.edit(field, [&](View<D> view) { from_array<D>(array, view, space.on_host()); });
}

/// Storage behind RigidState.
template <class Space>
struct RigidStateIn {
    typename Space::template FieldOf<3> position, velocity, omega;
    typename Space::template FieldOf<4> orientation;

    explicit RigidStateIn(ChainGroup const& group)
        : position(group.size), velocity(group.size), omega(group.size), orientation(group.size) {}

    RigidState view() {
        return {position.view(), velocity.view(), omega.view(), orientation.view()};
    }
    void set(Space const& space, RigidStart const& start) {
        fill(space, position, start.position);
        fill(space, velocity, start.velocity);
        fill(space, omega, start.omega);
        fill(space, orientation, start.orientation);
    }
    /// The state as checkpoints store it.
    std::vector<StateArray> arrays(Space const& space) const {
        return {to_array<3>("position", space.read(position).view(), space.on_host()),
                to_array<3>("velocity", space.read(velocity).view(), space.on_host()),
                to_array<4>("orientation", space.read(orientation).view(), space.on_host()),
                to_array<3>("omega", space.read(omega).view(), space.on_host())};
    }
    /// Restores the state from arrays().
    void set(Space const& space, std::vector<StateArray> const& arrays) {
        set_field<3>(space, position, array_named(arrays, "position"));
        set_field<3>(space, velocity, array_named(arrays, "velocity"));
        set_field<4>(space, orientation, array_named(arrays, "orientation"));
        set_field<3>(space, omega, array_named(arrays, "omega"));
    }
};

/// Velocities of the last AbsoluteDynamics::observe(), and host copies of what observers see.
template <class Space>
class ObservedBodiesIn {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;
    template <int D>
    using Mirror = typename Space::template Mirror<D>;

  public:
    explicit ObservedBodiesIn(ChainGroup const& group) : velocity(group.size), omega(group.size) {}
    /// Copies poses and observed velocities to the host. Waits.
    ObservedMotion pull(Space const& space, RigidStateIn<Space>& state) {
        return {space.pull(state.position, position_), space.pull(velocity, velocity_),
                space.pull(state.orientation, orientation_), space.pull(omega, omega_)};
    }

    FieldOf<3> velocity, omega;

  private:
    Mirror<3> position_, velocity_, omega_;
    Mirror<4> orientation_;
};

}  // namespace catena
