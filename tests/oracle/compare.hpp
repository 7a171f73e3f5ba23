// What the tests of the oracles share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "measure/nudged.hpp"
#include "oracle/oracle.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/reference_data.hpp"

namespace catena::test {

/// Gap above 1.
template <class S>
S epsilon() {
    S e(1);
    while (S(1) + e / S(2) > S(1)) e = e / S(2);
    return e;
}

/// A decimal number ("-0.00123", "1.5e-12") in any scalar, to a few units in the last place.
template <class S>
S parse(std::string const& text) {
    S value(0);
    int exponent = 0;
    bool behind_point = false;
    std::size_t i = text[0] == '-' ? 1 : 0;
    for (; i < text.size() && text[i] != 'e'; ++i) {
        if (text[i] == '.') {
            behind_point = true;
            continue;
        }
        value = value * S(10) + S(text[i] - '0');
        exponent -= behind_point ? 1 : 0;
    }
    if (i < text.size()) exponent += std::stoi(text.substr(i + 1));
    S power(1);
    for (int k = 0; k < std::abs(exponent); ++k) power = power * S(10);
    value = exponent < 0 ? S(value / power) : S(value * power);
    return text[0] == '-' ? S(-value) : value;
}
/// Torques and forces of wrenches, one after the other.
template <class S>
std::vector<Vector<S, 3>> torques(std::vector<oracle::SpatialForce<S>> const& wrenches) {
    std::vector<Vector<S, 3>> result;
    for (auto const& w : wrenches) result.push_back(w.torque);
    return result;
}
template <class S>
std::vector<Vector<S, 3>> forces(std::vector<oracle::SpatialForce<S>> const& wrenches) {
    std::vector<Vector<S, 3>> result;
    for (auto const& w : wrenches) result.push_back(w.force);
    return result;
}

template <class S>
S largest(std::vector<Vector<S, 3>> const& values) {
    S most(0);
    for (auto const& v : values)
        for (int i = 0; i < 3; ++i) most = std::max({most, v[i], S(-v[i])});
    return most;
}

/// Accelerations only: where a chain is held more than once, its forces are one choice of many.
enum class What { all, accelerations };

/// The quantities of a result.
template <class S>
std::vector<std::vector<Vector<S, 3>>> quantities(oracle::OracleResult<S> const& r, What what) {
    if (what == What::accelerations)
        return {r.qdd, r.com_acceleration, r.alpha, {r.base_acceleration}};
    std::vector<Vector<S, 3>> tension;
    for (S const& t : r.tension) tension.push_back({{t, S(0), S(0)}});
    return {r.qdd,
            r.com_acceleration,
            r.alpha,
            {r.base_acceleration},
            torques(r.joint_force),
            forces(r.joint_force),
            torques(r.constraint_force),
            forces(r.constraint_force),
            tension,
            {r.tip_force.torque},
            {r.tip_force.force}};
}

/// Largest difference between two results, each quantity relative to its own largest component; one
/// that the model keeps at zero (the rotation of a chain of prismatic joints) relative to the
/// largest of all, which is O(1) in these chains' units.
template <class S>
S difference(oracle::OracleResult<S> const& a, oracle::OracleResult<S> const& b,
             What what = What::all) {
    auto const of_a = quantities(a, what), of_b = quantities(b, what);
    S overall(0), worst(0);
    for (auto const& q : of_b) overall = std::max(overall, largest(q));
    for (std::size_t i = 0; i < of_b.size(); ++i) {
        S const own = largest(of_b[i]);
        S const error =
            own > S(0) ? S(relative_difference(of_a[i], of_b[i]) * own) : largest(of_a[i]);
        if (error > S(0))
            worst = std::max(worst, S(error / (own > S(1e-6) * overall ? own : overall)));
    }
    return worst;
}

/// How much a relative change of the inputs grows in the results, measured (three random changes of
/// 1e-8); at least 1.
inline double growth(ChainSpec const& chain, oracle::Loads const& loads) {
    double const size = 1e-8;
    auto const found = oracle::aba<double>(chain, loads);
    double most = 1;
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        most = std::max(
            most,
            difference(oracle::aba<double>(perturbed(seed, chain, size), loads), found) / size);
    return most;
}

/// The chain a time h later, correct to h^2 in coordinates and h in velocities with errors even in
/// h where it matters for central differences: spherical and free joints turn by the rotation
/// vector h (w + h/2 w') about their body's axes.
inline ChainSpec moved(ChainSpec chain, oracle::OracleResult<double> const& a, double h) {
    BodyArrays& b = chain.bodies;
    for (std::size_t k = 0; k < b.size(); ++k) {
        Vec3 const step = h * (b.qd[k] + (0.5 * h) * a.qdd[k]);
        if (b.joint[k] == JointType::spherical || b.joint[k] == JointType::free) {
            auto const& q = b.q[k];
            Quat const turned =
                normalized(Quat{q[0], q[1], q[2], q[3]} * from_rotation_vector(step));
            b.q[k] = {turned.w, turned.x, turned.y, turned.z};
        } else {
            for (int i = 0; i < 3; ++i) b.q[k][static_cast<std::size_t>(i)] += step[i];
        }
        b.qd[k] = b.qd[k] + h * a.qdd[k];
    }
    b.free_base.position =
        b.free_base.position + h * (b.free_base.velocity + (0.5 * h) * a.base_acceleration);
    b.free_base.velocity = b.free_base.velocity + h * a.base_acceleration;
    return chain;
}

/// Collects |aba - dense| over many chains against c n eps growth: both solvers are backward
/// stable, so each gives the exact answer of a problem changed by a few roundings a body, and
/// growth is what such a change does to the answer. c = 16: a body passes some tens of rounded
/// operations, which add up like a random walk.
template <class S>
class Agreement {
  public:
    /// The difference over its bound with c = 1.
    double add(ChainSpec const& chain, oracle::Loads const& loads) {
        double const error = static_cast<double>(
            difference(oracle::aba<S>(chain, loads), oracle::dense<S>(chain, loads)));
        double const unit = static_cast<double>(chain.size()) * static_cast<double>(epsilon<S>());
        double const ratio = error / (unit * growth(chain, loads));
        return take(chain, loads, error, ratio);
    }
    /// Accelerations alone, over n eps cond: of a chain held more than once, whose perturbed
    /// neighbours cannot move at all.
    double add_accelerations(ChainSpec const& chain, oracle::Loads const& loads) {
        double const error = static_cast<double>(difference(
            oracle::aba<S>(chain, loads), oracle::dense<S>(chain, loads), What::accelerations));
        double const unit = static_cast<double>(chain.size()) * static_cast<double>(epsilon<S>());
        return take(chain, loads, error, error / (unit * oracle::condition_estimate(chain, loads)));
    }
    double error() const { return error_; }
    void print() const {
        std::printf(
            "%d chains: largest |aba - dense| %.1e; over n eps growth %.2f, over n eps cond %.2f\n",
            count_, error_, ratio_, condition_ratio_);
    }

  private:
    double take(ChainSpec const& chain, oracle::Loads const& loads, double error, double ratio) {
        double const unit = static_cast<double>(chain.size()) * static_cast<double>(epsilon<S>());
        ++count_;
        error_ = std::max(error_, error);
        ratio_ = std::max(ratio_, ratio);
        condition_ratio_ =
            std::max(condition_ratio_, error / (unit * oracle::condition_estimate(chain, loads)));
        return ratio;
    }
    int count_ = 0;
    double error_ = 0, ratio_ = 0, condition_ratio_ = 0;
};

struct Case {
    ChainSpec chain;
    oracle::Loads loads;
};

/// Asserts that inverse dynamics accept the accelerations found, within c n eps growth.
inline void inverse_dynamics_agree(Case const& given, double c, double growth) {
    auto const found = oracle::aba<double>(given.chain, given.loads);
    ASSERT_LE(oracle::rnea_residual(given.chain, given.loads, found.qdd, found.base_acceleration),
              c * static_cast<double>(given.chain.size()) * 0x1p-52 * growth);
}

/// Asserts that the solvers agree on the chains of seeds 0 .. count - 1, within Agreement's c;
/// `check` asserts more of each chain. A seed may be without a chain.
template <class S>
void solvers_agree(
    int count, double c, std::function<std::optional<Case>(std::uint64_t)> const& random_case,
    std::function<void(Case const&)> const& check = [](Case const&) {}) {
    Agreement<S> agreement;
    for (int seed = 0; seed < count; ++seed) {
        std::optional<Case> const made = random_case(static_cast<std::uint64_t>(seed));
        if (!made) continue;
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(made->chain.size()) +
                     " bodies");
        ASSERT_LE(agreement.add(made->chain, made->loads), c);
        ASSERT_NO_FATAL_FAILURE(check(*made));
    }
    agreement.print();
    EXPECT_GT(agreement.error(), 0.0);  // two algorithms, not one
}

/// Largest second time derivative of some quantities, by their values a time h before, now and a
/// time h later.
inline double second_derivative(std::vector<double> const& behind, std::vector<double> const& now,
                                std::vector<double> const& ahead, double h) {
    double most = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
        most = std::max(most, std::abs(ahead[i] - 2 * now[i] + behind[i]) / (h * h));
    return most;
}

}  // namespace catena::test
