// Every backend and handle kind against the oracles: one test body.
#include <gtest/gtest.h>

#include <cmath>

#include "dca/oracle/oracle.hpp"
#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/reference_data.hpp"

namespace catena::test {
namespace {

double constexpr eps = 0x1p-53;

struct Variant {
    Backend backend;
    Handles handles;
};
std::string name_of_variant(testing::TestParamInfo<Variant> const& info) {
    return std::string(name_of(info.param.backend)) + "_" + name_of(info.param.handles);
}

class Solver : public testing::TestWithParam<Variant> {
  protected:
    void SetUp() override {
        if (GetParam().backend != Backend::openmp) return;
        try {
            openmp_executor(2);
        } catch (InputError const& error) {
            ASSERT_NE(std::string(error.what()).find("built without OpenMP"), std::string::npos);
            GTEST_SKIP() << "NOT RUN: this build is without OpenMP";
        }
    }
    Scene scene_of(ChainSpec const& chain, Vec3 const& gravity) const {
        Scene scene;
        scene.chains = {chain};
        scene.chains[0].name = "chain";
        scene.forces.gravity = gravity;
        scene.solver.backend = GetParam().backend;
        scene.solver.handles = GetParam().handles;
        scene.solver.threads = 2;
        return scene;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

/// Growth of relative errors from the inputs to the accelerations: no solver can be asked for less than this times eps.
double growth(ChainSpec const& chain, oracle::Loads const& loads) {
    double constexpr size = 0x1p-30;
    auto const exact = oracle::aba<long double>(chain, loads).qdd;
    auto const moved = oracle::aba<long double>(perturbed(1, chain, size), loads).qdd;
    return std::max(1.0, static_cast<double>(relative_difference(moved, exact)) / size);
}

TEST_P(Solver, RandomChainsAgreeWithTheArticulatedBodyAlgorithm) {
    double worst = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        RandomChainOptions options;
        options.bodies = 1 + seed % 40;
        options.joints = static_cast<RandomJoints>(seed % 3);
        options.base = seed / 3 % 2 ? Base::free : Base::fixed;
        options.springs = seed / 6 % 2;
        ChainSpec const chain = random_chain(seed, options);
        oracle::Loads const loads{{{0.3, -2.0, 9.0}}, {}};
        Scene const scene = scene_of(chain, loads.gravity);
        ChainSystem system(scene, Axes::joint, *communicator_);
        system.evaluate();
        ChainSystem::Accelerations const a = system.accelerations();
        auto const oracle = oracle::aba<long double>(chain, loads);
        double const n = static_cast<double>(options.bodies);
        double const bound = 32 * (n + 8) * growth(chain, loads) * eps;
        double const error = static_cast<double>(relative_difference(converted<long double>(a.joint_acceleration), oracle.qdd));
        worst = std::max(worst, error / bound);
        ASSERT_LE(error, bound) << "seed " << seed << ", " << n << " bodies";
        ASSERT_LE(system.residual(), system.residual_bound()) << "seed " << seed;
        Vector<long double, 3> const base{{a.base_acceleration[0][0], a.base_acceleration[0][1], a.base_acceleration[0][2]}};
        ASSERT_LE(static_cast<double>(norm(base - oracle.base_acceleration)),
                  bound * (1 + static_cast<double>(norm(oracle.base_acceleration))) * 4);
        std::vector<Vec3> torque, force;
        std::vector<Vector<long double, 3>> torque_expected, force_expected;
        for (std::size_t k = 0; k < chain.size(); ++k) {
            auto const& w = a.joint_force[k];
            torque.push_back({{w[0], w[1], w[2]}});
            force.push_back({{w[3], w[4], w[5]}});
            torque_expected.push_back(oracle.constraint_force[k].torque);
            force_expected.push_back(oracle.constraint_force[k].force);
        }
        ASSERT_LE(static_cast<double>(relative_difference(converted<long double>(force), force_expected)), 8 * bound) << "seed " << seed;
        if (options.joints == RandomJoints::spherical) continue;  // these transmit no torque
        ASSERT_LE(static_cast<double>(relative_difference(converted<long double>(torque), torque_expected)), 8 * bound) << "seed " << seed;
    }
    RecordProperty("worst_error_over_bound", std::to_string(worst));
}

TEST_P(Solver, BeadChainsAgreeWithTheOracle) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        std::size_t const n = 1 + seed * 7 % 300;
        ChainSpec const chain = random_bead_chain(seed, n, seed % 2 ? Base::free : Base::fixed);
        oracle::Loads const loads{{{1.0, 2.0, -3.0}}, {}};
        Scene const scene = scene_of(chain, loads.gravity);
        ChainSystem system(scene, Axes::joint, *communicator_);
        system.evaluate();
        auto const oracle = oracle::aba<long double>(chain, loads);
        auto const a = system.accelerations();
        double const bound = 64 * static_cast<double>(n + 8) * eps;
        ASSERT_LE(static_cast<double>(relative_difference(converted<long double>(a.acceleration), oracle.com_acceleration)), bound)
            << "seed " << seed << ", " << n << " beads";
        ASSERT_LE(system.residual(), system.residual_bound()) << "seed " << seed;
    }
}

TEST_P(Solver, ThirdPartyChains) {
    for (ReferenceChain const& reference : reference_chains()) {
        Scene const scene = scene_of(reference.chain, reference.gravity);
        ChainSystem system(scene, Axes::joint, *communicator_);
        system.evaluate();
        auto const a = system.accelerations();
        double const error = relative_difference(a.joint_acceleration, reference.qdd);
        EXPECT_LE(error, 1e-14) << reference.name;  // the digits of Simbody; the contract asks for 1e-12
        EXPECT_LE(system.residual(), system.residual_bound()) << reference.name;
        for (std::size_t k = 0; k < reference.pin_force.size(); ++k)
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(a.joint_force[k][3 + i], reference.pin_force[k][i], 1e-12 * norm(reference.pin_force.front()) * 4)
                    << reference.name << ", rod " << k + 1;
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Solver,
                         testing::Values(Variant{Backend::serial, Handles::projected}, Variant{Backend::serial, Handles::full},
                                         Variant{Backend::segments, Handles::projected}, Variant{Backend::segments, Handles::full},
                                         Variant{Backend::openmp, Handles::projected}, Variant{Backend::openmp, Handles::full}),
                         name_of_variant);

}  // namespace
}  // namespace catena::test
