// Implicit springs of spherical joints in absolute coordinates, for every Space: within a step of
// length h a spring K acts on a chain with a rotor in every joint, of inertia B = c h^2 K along the
// body's axes, that turns as the joint does (c: rotor_of_spring()). A rotor has a velocity of its
// own, as bodies have theirs, and the sweeps that close joints make both agree: kicks so that it is
// the joint's, drifts so that it is the joint's mean one.
#pragma once

#include "chain/chain_group.hpp"
#include "dca/solver.hpp"
#include "dynamics/body_loads.hpp"
#include "dynamics/constrained_step.hpp"
#include "math/philox.hpp"

namespace catena {

struct JointRotors {
    double of_stiffness = 0;                 // what of K is B
    std::uint8_t const* implicit = nullptr;  // whether joint k is; null where none is
    std::uint8_t const* is_first = nullptr;  // of its chain
    ConstView<3> stiffness;
    ConstView<4>
        orientation;     // of bodies; entry -1: of the neighbour's last body, as in what follows
    View<3> rate;        // of the rotor against the inboard body, B
    View<3> torque;      // of the spring, B
    View<4> flown;       // orientations at the end of a drift's flight
    View<6> compliance;  // ConfigurationView::compliance, W

    CATENA_HD bool has(std::int64_t k) const { return implicit && implicit[k] != 0; }
    CATENA_HD double inertia(std::int64_t k, int i) const {
        return of_stiffness * stiffness.at(k, i);
    }
    CATENA_HD Mat3 axes(std::int64_t k) const {
        return to_matrix(as_quaternion(orientation.load(k)));
    }
    /// What body k turns by against its inboard body, of what bodies turn by; all in their own
    /// axes.
    CATENA_HD Vec3 relative(ConstView<3> const& turning, std::int64_t k) const {
        Vec3 const own = turning.load(k);
        return is_first[k] ? own
                           : own - transposed_times(axes(k), axes(k - 1) * turning.load(k - 1));
    }

    CATENA_HD void set_compliance(std::int64_t k) const {
        auto c = Symmetric<double, 3>::zero();
        if (has(k)) {
            Mat3 const turn = axes(k);
            for (int i = 0; i < 3; ++i) {
                Vec3 const p = turn.column(i);
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
    /// For a kick: the rotor's momentum with h times the spring's torque.
    CATENA_HD void set_kick(DirectionsView const& bias, std::int64_t k, double h) const {
        for (int i = 0; i < 6; ++i) bias.at(k, i) = 0;
        if (!has(k)) return;
        Vec3 wanted = rate.load(k);
        Vec3 const by = torque.load(k);
        for (int i = 0; i < 3; ++i) wanted[i] += h * by[i] / inertia(k, i);
        store_angular(bias, k, -(axes(k) * wanted));
    }
    CATENA_HD void take(std::int64_t k, ConstView<3> const& omega) const {
        if (has(k)) rate.store(k, relative(omega, k));
    }
    CATENA_HD Quat gone(std::int64_t body) const {
        return conjugate(as_quaternion(orientation.load(body))) * as_quaternion(flown.load(body));
    }
    /// For a drift: how far the joint has turned beyond what its rotor has, `scale` times.
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
    /// What the sweep that closed them adds.
    CATENA_HD void add(DirectionsView const& bias, std::int64_t k,
                       ConstView<3> const& alpha) const {
        if (!has(k)) return;
        Vec3 const opening{{bias.at(k, 3), bias.at(k, 4), bias.at(k, 5)}};
        rate.store(k, rate.load(k) + relative(alpha, k) + transposed_times(axes(k), opening));
    }
    /// Harmonic springs sample exactly at any step (BAOAB). In the middle of drifts velocities u
    /// have the covariance kt (M + B)^-1; where forces are, at whole steps, kt (M + B)^-1 (M + B /
    /// 2) (M + B)^-1: rotors have half the variance there.
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

}  // namespace catena
