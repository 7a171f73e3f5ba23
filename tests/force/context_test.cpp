// Where a Context's particles are placed: coordinates go on where beads do, and forces are those of
// nearest images all the same.
#include "force/context.hpp"
#include "systems/plugins.hpp"

#include <gtest/gtest.h>

#include "tests/force/beads.hpp"

namespace catena::testing {
namespace {

class Places : public ::testing::Test {
  protected:
    static OpenMmPlatform platform(char const* name) {
        load_openmm_plugins();
        OpenMmPlatform platform;
        platform.platform = &OpenMM::Platform::getPlatformByName(name);
        return platform;
    }
    /// Two particles that attract each other up to 3 nm.
    static std::shared_ptr<OpenMM::System> pair(bool periodic) {
        auto system = std::make_shared<OpenMM::System>();
        system->setDefaultPeriodicBoxVectors({10, 0, 0}, {0, 10, 0}, {0, 0, 10});
        auto force = std::make_unique<OpenMM::CustomNonbondedForce>("r^2");
        force->setNonbondedMethod(periodic ? OpenMM::CustomNonbondedForce::CutoffPeriodic
                                           : OpenMM::CustomNonbondedForce::CutoffNonPeriodic);
        force->setCutoffDistance(3);
        for (int p = 0; p < 2; ++p) {
            system->addParticle(1);
            force->addParticle({});
        }
        system->addForce(force.release());
        return system;
    }
    double x(ForceContext& context, int particle) const {
        return context.context()
            .getState(OpenMM::State::Positions)
            .getPositions()[static_cast<std::size_t>(particle)][0];
    }
    Vec3 const box_{{10, 10, 10}};
    static double constexpr in_single =
        16 * 0x1p-24 * 10;  // of coordinates of 10 nm, times a slope of 2
};

TEST_F(Places, ABeadThatLeavesTheBoxGoesOn) {
    ForceContext context(pair(true), platform("CPU"), box_);
    context.set_positions(std::vector<Vec3>{{{-10.5, 5, 5}}, {{39, 5, 5}}},
                          2);  // 9.5 and 9: 0.5 apart
    EXPECT_DOUBLE_EQ(x(context, 0), 9.5);
    EXPECT_DOUBLE_EQ(x(context, 1), 9);
    context.set_positions(std::vector<Vec3>{{{-9.5, 5, 5}}, {{39, 5, 5}}}, 2);
    EXPECT_DOUBLE_EQ(x(context, 0), 10.5);
    EXPECT_NEAR(context.forces()[0][0], -3, in_single);
    EXPECT_NEAR(context.forces()[1][0], 3, in_single);
    context.place_anew();
    context.set_positions(std::vector<Vec3>{{{-9.5, 5, 5}}, {{39, 5, 5}}}, 2);
    EXPECT_DOUBLE_EQ(x(context, 0), 0.5);
    EXPECT_NEAR(context.forces()[0][0], -3, in_single);
}

TEST_F(Places, AreFoundAnewForAStrayAndAfterAWhile) {
    ForceContext context(pair(true), platform("CPU"), box_);
    auto const set = [&](double first) {
        context.set_positions(std::vector<Vec3>{{{first, 5, 5}}, {{5, 5, 5}}}, 2);
    };
    set(9);
    set(14.9);
    EXPECT_DOUBLE_EQ(x(context, 0), 14.9);
    set(15.1);  // half a box outside
    EXPECT_DOUBLE_EQ(x(context, 0), 15.1 - 10);
    context.place_anew();
    set(9.5);
    int evaluations = 0;
    for (set(10.5); x(context, 0) > 10 && evaluations < 1000; ++evaluations) set(10.5);
    EXPECT_DOUBLE_EQ(x(context, 0), 0.5);
    EXPECT_GT(evaluations, 100);
    EXPECT_LT(evaluations, 300);
}

/// A restart there is the uninterrupted run to the bit.
TEST_F(Places, OnReferenceDependOnThesePositionsAlone) {
    ForceContext context(pair(true), platform("Reference"), box_);
    for (double const first : {9.5, 10.5, -0.25}) {
        context.set_positions(std::vector<Vec3>{{{first, 5, 5}}, {{5, 5, 5}}}, 2);
        EXPECT_DOUBLE_EQ(x(context, 0), first < 0 ? first + 10 : first < 10 ? first : first - 10);
    }
}

TEST_F(Places, InTheOpenTheMiddleGoesToTheOriginForAWhile) {
    ForceContext context(pair(false), platform("CPU"), std::nullopt);
    context.set_positions(std::vector<Vec3>{{{1000, 0, 0}}, {{1002, 0, 0}}}, 2);
    EXPECT_DOUBLE_EQ(x(context, 0), -1);
    context.set_positions(std::vector<Vec3>{{{1001, 0, 0}}, {{1003, 0, 0}}}, 2);
    EXPECT_DOUBLE_EQ(x(context, 0), 0);
    EXPECT_NEAR(context.forces()[0][0], 4, in_single);
    context.place_anew();
    context.set_positions(std::vector<Vec3>{{{1001, 0, 0}}, {{1003, 0, 0}}}, 2);
    EXPECT_DOUBLE_EQ(x(context, 0), -1);
}

/// A state that is set, or another copy's frame.
TEST_F(Places, InTheOpenAreFoundAnewAfterAJump) {
    ForceContext context(pair(false), platform("CPU"), std::nullopt);
    auto const set = [&](double first) {
        context.set_positions(std::vector<Vec3>{{{first, 0, 0}}, {{first + 2, 0, 0}}}, 2);
    };
    set(0);
    set(9);
    EXPECT_DOUBLE_EQ(x(context, 0), 8);
    set(11);  // farther than 10 nm from the start
    EXPECT_DOUBLE_EQ(x(context, 0), -1);
    set(-50000.25);
    EXPECT_DOUBLE_EQ(x(context, 0), -1);
    EXPECT_NEAR(context.forces()[0][0], 4, in_single);
}

/// A run that writes energies is the run that does not: the same bits, as long as one thread adds
/// up forces.
TEST(PlacesOfARun, DoNotDependOnWhenEnergiesAreAskedFor) {
    BeadSystem const beads = proteins({random_sequence(60, 1)});
    OpenMmSpec spec = on_reference();
    spec.platform = "CPU";
    spec.threads = 1;
    auto const serial = serial_communicator();
    auto const quiet = make_openmm_force(spec, beads, *serial),
               asked = make_openmm_force(spec, beads, *serial);
    auto positions = wound(beads, 3);
    for (int step = 0; step < 300; ++step) {
        EXPECT_EQ(difference(evaluate(*asked, positions), evaluate(*quiet, positions)), 0) << step;
        asked->energies();
        for (Vec3& x : positions) x[1] += 0.01;
    }
}

}  // namespace
}  // namespace catena::testing
