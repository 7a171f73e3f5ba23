// Implicit springs of spherical joints in absolute coordinates, in any Space. Within a step of
// length h, a spring K acts as a rotor in the joint, with inertia B = c h^2 K along the body's axes
// (c: rotor_of_spring()). The rotor rotates with the joint.
//
// A rotor has its own velocity, as bodies do, and the sweeps that close joints keep it consistent.
// A kick makes it equal to the joint's velocity, a drift to the joint's mean velocity.
#pragma once

#include "dca/host_space.hpp"
#include "dynamics/body_loads.hpp"
#include "dynamics/constrained_step.hpp"
#include "dynamics/rigid/rigid_state.hpp"
#include "math/philox.hpp"

namespace catena {

/// Rotors of a group's implicit joints, with the operations of one joint.
struct JointRotors {
    double of_stiffness = 0;  // B / K, that is c h^2.
    /// True for joint k if it is implicit; null if no joint is.
    std::uint8_t const* implicit = nullptr;
    /// True for body k if it begins its chain.
    std::uint8_t const* is_first = nullptr;
    ConstView<3> stiffness;
    /// Quaternion of B in W, by body. Entry -1, here and in the fields below, is the inboard
    /// neighbour's last body.
    ConstView<4> orientation;
    /// Angular velocity of the rotor relative to the inboard body, B.
    View<3> rate;
    View<3> torque;      // Torque of the spring, B.
    View<4> flown;       // Orientations at the end of a drift's free flight.
    View<6> compliance;  // Compliance B^-1 in W (ConfigurationView::compliance).

    /// True if joint k is implicit.
    CATENA_HD bool has(std::int64_t k) const { return implicit && implicit[k] != 0; }
    /// Inertia B of the rotor about body axis i, amu nm^2.
    CATENA_HD double inertia(std::int64_t k, int i) const {
        return of_stiffness * stiffness.at(k, i);
    }
    /// Rotation matrix of B in W.
    CATENA_HD Mat3 axes(std::int64_t k) const {
        return to_matrix(as_quaternion(orientation.load(k)));
    }
    /// Angular velocity of body k relative to its inboard body, B. `turning` holds the angular
    /// velocities (or accelerations) of bodies in their own axes.
    CATENA_HD Vec3 relative(ConstView<3> const& turning, std::int64_t k) const {
        Vec3 const own = turning.load(k);
        return is_first[k] ? own
                           : own - transposed_times(axes(k), axes(k - 1) * turning.load(k - 1));
    }

    /// Sets the compliance of joint k, in W; zero if it is not implicit.
    CATENA_HD void set_compliance(std::int64_t k) const {
        auto c = Symmetric<double, 3>::zero();
        if (has(k)) {
            Mat3 const rotation = axes(k);
            for (int i = 0; i < 3; ++i) {
                Vec3 const p = rotation.column(i);
                double const yields = 1 / inertia(k, i);
                for (int row = 0; row < 3; ++row)
                    for (int column = 0; column <= row; ++column)
                        c(row, column) = fused(yields * p[row], p[column], c(row, column));
            }
        }
        Vector<double, 6> numbers;
        for (int i = 0; i < 6; ++i) numbers[i] = c.data[i];
        compliance.store(k, numbers);
    }
    CATENA_HD static void store_angular(DirectionsView const& bias, std::int64_t k,
                                        Vec3 const& value) {
        for (int i = 0; i < 3; ++i) bias.at(k, 3 + i) = value[i];
    }
    /// Sets the bias of joint k for a kick: the rotor's rate after its own kick h by the spring's
    /// torque.
    CATENA_HD void set_kick(DirectionsView const& bias, std::int64_t k, double h) const {
        for (int i = 0; i < 6; ++i) bias.at(k, i) = 0;
        if (!has(k)) return;
        Vec3 wanted = rate.load(k);
        Vec3 const by = torque.load(k);
        for (int i = 0; i < 3; ++i) wanted[i] += h * by[i] / inertia(k, i);
        store_angular(bias, k, -(axes(k) * wanted));
    }
    /// Sets the rotor's rate to the joint's, after a projection.
    CATENA_HD void take(std::int64_t k, ConstView<3> const& omega) const {
        if (has(k)) rate.store(k, relative(omega, k));
    }
    /// Rotation of a body during the drift's flight, in its axes at the start.
    CATENA_HD Quat gone(std::int64_t body) const {
        return conjugate(as_quaternion(orientation.load(body))) * as_quaternion(flown.load(body));
    }
    /// Sets the bias of joint k for a drift: `scale` times the joint's rotation vector, less the
    /// rotor's rate.
    CATENA_HD void set_opening(DirectionsView const& bias, std::int64_t k, double scale) const {
        if (!has(k)) return;
        Quat const own = gone(k);
        Quat turned = own;
        if (!is_first[k]) {
            Quat const q = as_quaternion(orientation.load(k)),
                       before = as_quaternion(orientation.load(k - 1));
            turned = conjugate(q) * before * conjugate(gone(k - 1)) * conjugate(before) * q * own;
        }
        store_angular(bias, k, axes(k) * (scale * rotation_vector(turned) - rate.load(k)));
    }
    /// Adds a sweep's correction to the rotor's rate.
    CATENA_HD void add(DirectionsView const& bias, std::int64_t k,
                       ConstView<3> const& alpha) const {
        if (!has(k)) return;
        Vec3 const opening{{bias.at(k, 3), bias.at(k, 4), bias.at(k, 5)}};
        rate.store(k, rate.load(k) + relative(alpha, k) + transposed_times(axes(k), opening));
    }
    /// Mixes the rotor's rate with noise. BAOAB samples harmonic springs exactly at any step. In
    /// the middle of drifts, velocities u have the covariance kt (M + B)^-1. At whole steps, where
    /// forces are computed, it is kt (M + B)^-1 (M + B / 2) (M + B)^-1: rotors have half the
    /// variance there.
    CATENA_HD void add_noise(std::int64_t k, Thermostat const& t, std::uint64_t step,
                             std::uint64_t body, bool between_drifts) const {
        if (!has(k)) return;
        Vec3 noise =
            normal3(t.seed, step, body,
                    between_drifts ? NoiseStage::thermostat_joint : NoiseStage::start_joint);
        for (int i = 0; i < 3; ++i) noise[i] /= std::sqrt((between_drifts ? 1 : 2) * inertia(k, i));
        rate.store(k, plus_scaled(t.keep * rate.load(k), t.spread, noise));
    }
};

/// Storage behind JointRotors; empty if no joint is implicit.
template <class Space>
class JointRotorsIn {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;

  public:
    /// `of_stiffness`: B / K.
    JointRotorsIn(ChainGroup const& group, double of_stiffness)
        : of_stiffness_(of_stiffness),
          size_(std::ssize(group.joints.implicit)),
          implicit_(group.joints.implicit),
          rate_(size_),
          torque_(size_),
          flown_(size_),
          compliance_(size_) {}

    /// True if a joint of this rank is implicit.
    explicit operator bool() const { return size_ > 0; }
    /// Precondition: there are implicit joints.
    JointRotors view(std::uint8_t const* is_first, ConstView<3> const& stiffness,
                     ConstView<4> const& orientation) {
        return {of_stiffness_, implicit_.data(), is_first,      stiffness,         orientation,
                rate_.view(),  torque_.view(),   flown_.view(), compliance_.view()};
    }
    View<4> flown() { return flown_.view(); }
    ConstView<6> compliance() const { return compliance_.view(); }
    /// Adds the rotors' rates to the arrays of a checkpoint. They are stored on ranks without
    /// implicit joints too.
    void add_arrays(Space const& space, std::vector<StateArray>& arrays) const {
        if (of_stiffness_ > 0)
            arrays.push_back(to_array<3>("rotor", space.read(rate_).view(), space.on_host()));
    }
    void set(Space const& space, std::vector<StateArray> const& arrays) {
        if (size_ > 0) set_field<3>(space, rate_, array_named(arrays, "rotor"));
    }

  private:
    double of_stiffness_;
    std::int64_t size_;
    typename Space::template List<std::uint8_t> implicit_;
    FieldOf<3> rate_, torque_;
    FieldOf<4> flown_;
    FieldOf<6> compliance_;
};

}  // namespace catena
