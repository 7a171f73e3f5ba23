// Step of an embedded Runge-Kutta pair for the coordinates of one body in joint coordinates, and
// the difference of its two orders, in any Space.
#pragma once

#include "dynamics/joint/joint_dynamics.hpp"
#include "dynamics/joint/joint_steps.hpp"
#include "joints/joint_models.hpp"

namespace catena {

/// Rates of all stages, with the operations on one body.
struct EmbeddedSteps {
    /// Numbers kept per stage: rates of q and qd of a body; rates of position and velocity of a
    /// base.
    static constexpr int rates = 7, base_rates = 6;
    JointSteps steps;
    View<EmbeddedStage::stages * rates> kept;  // Stages one after the other.
    View<EmbeddedStage::stages * base_rates> kept_base;

    /// Keeps the current rates and moves the state to the next stage; after the last stage, to the
    /// end of the step.
    template <bool positions, class Place>
    CATENA_HD void advance(Place k, EmbeddedStage const& s) const {
        using Real = RealAt<Place>;
        JointChains const& chains = steps.chains;
        StateView const &state = chains.moved.scan.state, &start = steps.start;
        bool const first = s.number == 0, last = s.number == EmbeddedStage::stages - 1;
        if (first && !s.again) {
            write(start.q, k, read(state.q, k));
            write(start.qd, k, read(state.qd, k));
        }
        if (!s.again)
            write(of_stage(s.number), k,
                  rates_of(k, first ? read(steps.saved.qdd, k) : chains.rate(k)));
        Vector<Real, 4> q = read(start.q, k);
        Vec3At<Place> qd = read(start.qd, k);
        for (int i = 0; i <= s.number; ++i) {
            Vector<Real, rates> const rate = read(of_stage(i), k);
            Real const weight(s.weight[i]);
            for (int c = 0; c < 4; ++c) q[c] = fused(weight, rate[c], q[c]);
            for (int c = 0; c < 3; ++c) qd[c] = fused(weight, rate[4 + c], qd[c]);
        }
        if (last && chains.moved.joints().has_quaternion(k))
            q = as_vector(normalized(as_quaternion(q)));
        write(state.q, k, q);
        write(state.qd, k, qd);
        if constexpr (is_one_body<Place>) {
            if (chains.on_free_base(k)) advance_base(chains.moved.joints().piece_of(k), k, s);
            chains.moved.joints().follow_course(state, k, s.time);
        }
        if (!chains.left.motions) chains.template set_relative<positions>(k);
    }
    /// Counterpart of advance() for the free base of a piece.
    CATENA_HD void advance_base(std::int64_t piece, std::int64_t k, EmbeddedStage const& s) const {
        StateView const &state = steps.chains.moved.scan.state, &start = steps.start;
        bool const first = s.number == 0;
        if (first && !s.again) {
            start.base_position.store(piece, state.base_position.load(piece));
            start.base_velocity.store(piece, state.base_velocity.load(piece));
        }
        if (!s.again) {
            Vec3 const v = state.base_velocity.load(piece);
            Vec3 const a =
                first ? steps.saved.base_acceleration.load(piece) : steps.chains.base_rate(k);
            base_of_stage(s.number).store(
                piece, Vector<double, base_rates>{{v[0], v[1], v[2], a[0], a[1], a[2]}});
        }
        Vec3 x = start.base_position.load(piece), v = start.base_velocity.load(piece);
        for (int i = 0; i <= s.number; ++i) {
            Vector<double, base_rates> const rate = base_of_stage(i).load(piece);
            for (int c = 0; c < 3; ++c) {
                x[c] = fused(s.weight[i], rate[c], x[c]);
                v[c] = fused(s.weight[i], rate[3 + c], v[c]);
            }
        }
        state.base_position.store(piece, x);
        state.base_velocity.store(piece, v);
    }

    /// Measure of how implausible a stage is: 1 or more if it is so far from any useful step that
    /// its equations may have no solution. NaN if it is not finite. Orientations are measured by
    /// the deviation of the quaternion's length from 1, and velocities relative to 1000 rad per
    /// step.
    CATENA_HD double stage_divergence(std::int64_t k, double length) const {
        StateView const& state = steps.chains.moved.scan.state;
        Vector<double, 4> const q = state.q.load(k);
        Vec3 const qd = state.qd.load(k);
        double const size = dot(q, q), fast = 1e-3 * length * norm(of_kind(k, true, qd));
        if (!steps.chains.moved.joints().has_quaternion(k))
            return worse(fast, 0.0 * size + 0.0 * norm(qd));
        return worse(fast, worse(0.25 * size, 0.25 / size));
    }
    /// Velocity of body k, or of its base: the larger one of the step's two ends. `angular` selects
    /// the kind.
    CATENA_HD double speed(std::int64_t k, bool angular) const {
        JointChains const& chains = steps.chains;
        StateView const &state = chains.moved.scan.state, &start = steps.start;
        double const fastest = worse(norm(of_kind(k, angular, start.qd.load(k))),
                                     norm(of_kind(k, angular, state.qd.load(k))));
        if (angular || !chains.on_free_base(k)) return fastest;
        std::int64_t const p = chains.moved.joints().piece_of(k);
        return worse(norm(start.base_velocity.load(p)), norm(state.base_velocity.load(p)));
    }
    /// Largest difference of the two orders relative to the tolerances. Precondition: the rates at
    /// the step's end have been solved for. Differences of orientations are rotation vectors.
    /// Prescribed motion has no error.
    CATENA_HD double error(std::int64_t k, EmbeddedDifference const& d,
                           AllowedErrors const& allowed) const {
        JointChains const& chains = steps.chains;
        if (chains.moved.drive_of(k)) return 0;
        Vector<double, rates> e = d.weight[EmbeddedStage::stages] * rates_of(k, chains.rate(k));
        for (int i = 0; i < EmbeddedStage::stages; ++i)
            e = plus_scaled(e, d.weight[i], of_stage(i).load(k));
        Vec3 const of_speed{{e[4], e[5], e[6]}};
        Vec3 of_place{{e[0], e[1], e[2]}};
        if (chains.moved.joints().has_quaternion(k)) {
            Quat const off = conjugate(as_quaternion(chains.moved.scan.state.q.load(k))) *
                             Quat{e[0], e[1], e[2], e[3]};
            of_place = {{2 * off.x, 2 * off.y, 2 * off.z}};
        }
        double const worst = worse(worse(norm(of_kind(k, true, of_place)) / allowed.angle,
                                         norm(of_kind(k, true, of_speed)) / allowed.speed.angular),
                                   worse(norm(of_kind(k, false, of_place)) / allowed.length,
                                         norm(of_kind(k, false, of_speed)) / allowed.speed.linear));
        return chains.on_free_base(k) ? worse(worst, base_error(k, d, allowed)) : worst;
    }
    /// Counterpart of error() for a free base.
    CATENA_HD double base_error(std::int64_t k, EmbeddedDifference const& d,
                                AllowedErrors const& allowed) const {
        std::int64_t const p = steps.chains.moved.joints().piece_of(k);
        double const after = d.weight[EmbeddedStage::stages];
        Vec3 x = after * steps.chains.moved.scan.state.base_velocity.load(p),
             v = after * steps.chains.base_rate(k);
        for (int i = 0; i < EmbeddedStage::stages; ++i) {
            Vector<double, base_rates> const rate = base_of_stage(i).load(p);
            x = plus_scaled(x, d.weight[i], Vec3{{rate[0], rate[1], rate[2]}});
            v = plus_scaled(v, d.weight[i], Vec3{{rate[3], rate[4], rate[5]}});
        }
        return worse(norm(x) / allowed.length, norm(v) / allowed.speed.linear);
    }

  private:
    /// Numbers of joint k's coordinates that are angles, or lengths unless `angular`; the others
    /// become 0.
    CATENA_HD Vec3 of_kind(std::int64_t k, bool angular, Vec3 const& numbers) const {
        JointType const type = steps.chains.moved.joints().joint[k];
        Vec3 of_it = numbers;
        for (int i = 0; i < 3; ++i)
            if (is_length(type, i) == angular) of_it[i] = 0;
        return of_it;
    }
    /// Maximum that keeps NaN.
    CATENA_HD static double worse(double a, double b) { return b > a || b != b ? b : a; }
    CATENA_HD View<rates> of_stage(int i) const {
        return kept.template components<rates>(i * rates);
    }
    CATENA_HD View<base_rates> base_of_stage(int i) const {
        return kept_base.template components<base_rates>(i * base_rates);
    }
    /// Rates of q and qd of body k, given its second derivatives.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, rates> rates_of(Place k, Vec3At<Place> const& qdd) const {
        using Real = RealAt<Place>;
        StateView const& state = steps.chains.moved.scan.state;
        Vec3At<Place> const qd = read(state.qd, k);
        Vector<Real, 4> const q =
            steps.chains.moved.joints().has_quaternion(k)
                ? JointSteps::rate_of_quaternion(as_quaternion(read(state.q, k)), qd)
                : Vector<Real, 4>{{qd[0], qd[1], qd[2], Real(0)}};
        return {{q[0], q[1], q[2], q[3], qdd[0], qdd[1], qdd[2]}};
    }
};

/// Storage of the stages' rates.
template <class Space>
struct EmbeddedRates {
    typename Space::template FieldOf<EmbeddedStage::stages * EmbeddedSteps::rates> kept;
    typename Space::template FieldOf<EmbeddedStage::stages * EmbeddedSteps::base_rates> kept_base;

    explicit EmbeddedRates(ChainGroup const& group)
        : kept(group.size), kept_base(std::ssize(group.pieces)) {}
};

}  // namespace catena
