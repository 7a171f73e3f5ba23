// What the tests of the oracles share.
#pragma once

#include <algorithm>
#include <cstdio>

#include "dca/oracle/oracle.hpp"
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

/// Largest difference between two results, each quantity relative to its own largest component.
template <class S>
S difference(oracle::OracleResult<S> const& a, oracle::OracleResult<S> const& b) {
    using V = std::vector<Vector<S, 3>>;
    S worst(0);
    auto const take = [&](V const& x, V const& y) { worst = std::max(worst, relative_difference(x, y)); };
    take(a.qdd, b.qdd);
    take(a.com_acceleration, b.com_acceleration);
    take(a.alpha, b.alpha);
    take(V{a.base_acceleration}, V{b.base_acceleration});
    take(torques(a.joint_force), torques(b.joint_force));
    take(forces(a.joint_force), forces(b.joint_force));
    take(torques(a.constraint_force), torques(b.constraint_force));
    take(forces(a.constraint_force), forces(b.constraint_force));
    V tension_a, tension_b;
    for (S const& t : a.tension) tension_a.push_back({{t, S(0), S(0)}});
    for (S const& t : b.tension) tension_b.push_back({{t, S(0), S(0)}});
    take(tension_a, tension_b);
    return worst;
}

/// How much a relative change of the inputs grows in the results, measured (three random changes of 1e-8); at least 1.
inline double growth(ChainSpec const& chain, oracle::Loads const& loads) {
    double const size = 1e-8;
    auto const found = oracle::aba<double>(chain, loads);
    double most = 1;
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        most = std::max(most, difference(oracle::aba<double>(perturbed(seed, chain, size), loads), found) / size);
    return most;
}

/// Collects |aba - dense| over many chains against c n eps growth: both solvers are backward stable, so each gives the exact
/// answer of a problem changed by a few roundings a body, and growth is what such a change does to the answer. c = 16: a body
/// passes some tens of rounded operations, which add up like a random walk.
template <class S>
class Agreement {
  public:
    /// The difference over its bound with c = 1.
    double add(ChainSpec const& chain, oracle::Loads const& loads) {
        double const error = static_cast<double>(difference(oracle::aba<S>(chain, loads), oracle::dense<S>(chain, loads)));
        double const unit = static_cast<double>(chain.size()) * static_cast<double>(epsilon<S>());
        double const ratio = error / (unit * growth(chain, loads));
        ++count_;
        error_ = std::max(error_, error);
        ratio_ = std::max(ratio_, ratio);
        condition_ratio_ = std::max(condition_ratio_, error / (unit * oracle::condition_estimate(chain)));
        return ratio;
    }
    double error() const { return error_; }
    void print() const {
        std::printf("%d chains: largest |aba - dense| %.1e; over n eps growth %.2f, over n eps cond %.2f\n", count_, error_, ratio_,
                    condition_ratio_);
    }

  private:
    int count_ = 0;
    double error_ = 0, ratio_ = 0, condition_ratio_ = 0;
};

}  // namespace catena::test
