// The oracles against Pinocchio's 60-digit accelerations of two chains and the 50-digit planar
// pendulums.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/oracle/compare.hpp"

namespace catena::test {
namespace {

using oracle::Quad;

template <class S>
struct Name;
template <>
struct Name<double> {
    static constexpr char const* value = "double";
};
template <>
struct Name<long double> {
    static constexpr char const* value = "long double";
};
template <>
struct Name<Quad> {
    static constexpr char const* value = "113 bits";
};

/// Digits as vectors along axis `component`.
template <class S>
std::vector<Vector<S, 3>> from_digits(std::vector<std::string> const& digits, int component) {
    std::vector<Vector<S, 3>> result;
    for (std::string const& text : digits) {
        result.push_back(Vector<S, 3>::zero());
        result.back()[component] = parse<S>(text);
    }
    return result;
}

/// Growth of a relative input error in q'': the files' own figure where they give one; the rods' is
/// small (their inputs are exact, and from rest nothing but the solution's decay along the chain
/// amplifies).
double growth(ReferenceChain const& r) {
    auto const given = r.agreement.find("change_when_every_input_moves_by_2pow_minus52_relative");
    return given == r.agreement.end() ? 8.0 : given->second / 0x1p-52;
}

/// c growth (sqrt(n) eps + data): every body's rounding enters like a changed input and adds up
/// like a random walk; `data` is what the reference itself leaves open (rotation matrices and axes
/// that are orthonormal to 2^-53 only, values rounded to double). The body accelerations and forces
/// sum over the chain: c = 8 instead of 2.
template <class S>
double bound(ReferenceChain const& r, double c, double data) {
    return c * growth(r) *
           (std::sqrt(static_cast<double>(r.chain.size())) * static_cast<double>(epsilon<S>()) +
            data);
}

template <class S>
class Solvers : public ::testing::Test {
  protected:
    using V = std::vector<Vector<S, 3>>;
    using Solve = oracle::OracleResult<S> (*)(ChainSpec const&, oracle::Loads const&);

    void pinocchio(std::string const& name, char const* solver, Solve solve) {
        ReferenceChain const& r = reference_chain(name);
        auto const result = solve(r.chain, {r.gravity, {}});
        check(r, solver, "q''", result.qdd, converted<S>(r.qdd), bound<S>(r, 2, 0x1p-52));
        check(r, solver, "alpha", result.alpha, converted<S>(r.alpha), bound<S>(r, 8, 0x1p-52));
        check(r, solver, "com acceleration", result.com_acceleration,
              converted<S>(r.com_acceleration), bound<S>(r, 8, 0x1p-52));
    }
    void rods(std::string const& name, char const* solver, Solve solve) {
        ReferenceChain const& r = reference_chain(name);
        auto const result = solve(r.chain, {r.gravity, {}});
        check(r, solver, "q''", result.qdd, from_digits<S>(r.qdd_digits, 0), bound<S>(r, 2, 0));
        check(r, solver, "alpha", result.alpha, from_digits<S>(r.alpha_digits, 2),
              bound<S>(r, 2, 0));
        check(r, solver, "pin force", forces(result.joint_force), converted<S>(r.pin_force),
              bound<S>(r, 2, 0x1p-53));
        check(r, solver, "pin force", forces(result.constraint_force), converted<S>(r.pin_force),
              bound<S>(r, 2, 0x1p-53));
    }

  private:
    static void check(ReferenceChain const& r, char const* solver, char const* what, V const& found,
                      V const& expected, double allowed) {
        double const error = static_cast<double>(relative_difference(found, expected));
        std::printf("%-14s %-6s %-12s %-17s error %.1e of the largest (allowed %.1e)\n",
                    r.name.c_str(), solver, Name<S>::value, what, error, allowed);
        EXPECT_EQ(found.size(), expected.size());
        EXPECT_LE(error, allowed) << r.name << ' ' << what;
    }
};
using Scalars = ::testing::Types<double, long double, Quad>;
TYPED_TEST_SUITE(Solvers, Scalars);

TYPED_TEST(Solvers, ArticulatedBodyReachesPinocchio) {
    for (char const* name : {"chain3", "chain50"})
        this->pinocchio(name, "aba", oracle::aba<TypeParam>);
}
TYPED_TEST(Solvers, ArticulatedBodyReachesTheRods) {
    for (char const* name : {"rods-8 rest", "rods-8 moving", "rods-32 rest", "rods-32 moving"})
        this->rods(name, "aba", oracle::aba<TypeParam>);
}
TYPED_TEST(Solvers, DenseReachesPinocchio) {
    this->pinocchio("chain3", "dense", oracle::dense<TypeParam>);
    if (!std::is_same_v<TypeParam, Quad>)
        this->pinocchio("chain50", "dense", oracle::dense<TypeParam>);  // 113 bits: seconds
}
TYPED_TEST(Solvers, DenseReachesTheRods) {
    for (char const* name : {"rods-8 rest", "rods-8 moving"})
        this->rods(name, "dense", oracle::dense<TypeParam>);
    if (std::is_same_v<TypeParam, Quad>) return;
    for (char const* name : {"rods-32 rest", "rods-32 moving"})
        this->rods(name, "dense", oracle::dense<TypeParam>);
}

TEST(Reference, KinematicsAndEnergies) {
    for (char const* name : {"chain3", "chain50"}) {
        ReferenceChain const& r = reference_chain(name);
        auto const k = oracle::kinematics<double>(r.chain, {r.gravity, {}});
        double const allowed = 16 * static_cast<double>(r.chain.size()) *
                               0x1p-53;  // one product and sum of rotations a body
        EXPECT_LE(relative_difference(k.com_position, r.com_position), allowed);
        EXPECT_LE(relative_difference(k.com_velocity, r.com_velocity), allowed);
        EXPECT_LE(relative_difference(k.omega, r.omega), allowed);
        EXPECT_NEAR(k.kinetic_energy, *r.kinetic_energy, allowed * *r.kinetic_energy);
        EXPECT_NEAR(k.potential_energy, *r.potential_energy,
                    allowed * std::abs(*r.potential_energy));
        EXPECT_EQ(k.spring_energy, 0.0);
    }
}

TEST(Reference, ConditionNumbers) {
    for (ReferenceChain const& r : reference_chains()) {
        double const allowed = static_cast<double>(r.chain.size()) * 0x1p-53 *
                               r.condition;  // the least eigenvalue's relative error
        EXPECT_NEAR(oracle::condition_estimate(r.chain) / r.condition, 1, allowed) << r.name;
    }
}

/// The residual of the given accelerations is rounding times the condition number; a changed
/// acceleration shows at once.
TEST(Reference, InverseDynamicsAcceptsTheAccelerationsAndNoOthers) {
    for (ReferenceChain const& r : reference_chains()) {
        oracle::Loads const loads{r.gravity, {}};
        double const residual = oracle::rnea_residual(r.chain, loads, r.qdd);
        std::printf("%-14s inverse dynamics of the reference q'': %.1e\n", r.name.c_str(),
                    residual);
        EXPECT_LE(residual, static_cast<double>(r.chain.size()) * 0x1p-52 * r.condition) << r.name;
        std::vector<Vec3> changed = r.qdd;
        changed[changed.size() / 2][0] += 1e-3;
        EXPECT_GT(oracle::rnea_residual(r.chain, loads, changed), 1e3 * residual) << r.name;
    }
}

}  // namespace
}  // namespace catena::test
