// Simulations in memory: stops, checkpoints, failures and what is said at the start.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/catena/models.hpp"

namespace catena::test {
namespace {

std::string message_of(auto const& action) {
    try {
        action();
    } catch (Error const& error) {
        return error.what();
    }
    return "";
}

Model pendulum() {
    return model_of(rods(revolute(), 3), "rk4", 0.001).set("forces.gravity", "[0, 0, -9.81]");
}

TEST(Simulation, StopsWhereItIsAskedToWithTheSameBits) {
    Simulation whole(pendulum()), stopped(pendulum());
    EXPECT_EQ(whole.run(100), 100);
    EXPECT_EQ(stopped.run(100, [](std::int64_t step) { return step < 37; }), 37);
    EXPECT_EQ(stopped.step(), 37);
    EXPECT_EQ(stopped.run(63), 63);
    EXPECT_EQ(stopped.state().position, whole.state().position);
}

TEST(Simulation, TakesTheLargestNumberOfStepsAfterOthers) {
    Simulation simulation(pendulum());
    simulation.run(5);
    auto const until_eight = [](std::int64_t step) { return step < 8; };
    EXPECT_EQ(simulation.run(std::numeric_limits<std::int64_t>::max(), until_eight), 3);
}

TEST(Simulation, GoesOnAfterAnExceptionOfItsObserver) {
    Simulation simulation(pendulum());
    EXPECT_THROW(simulation.run(10, [](std::int64_t) -> bool { throw std::runtime_error("no"); }),
                 std::runtime_error);
    EXPECT_EQ(simulation.step(), 1);
    EXPECT_EQ(simulation.run(9), 9);
}

TEST(Simulation, ContinuesFromACheckpointWithTheSameBits) {
    for (Model const& model : {pendulum(), model_of(beads(12), "rattle", 0.01)}) {
        Simulation first(model), second(model);
        first.run(50);
        std::string const kept = first.checkpoint();
        first.run(60);
        second.restore(kept);
        EXPECT_EQ(second.step(), 50);
        second.run(60);
        EXPECT_EQ(second.time(), first.time());
        EXPECT_EQ(second.state().position, first.state().position);
        EXPECT_EQ(second.state().velocity, first.state().velocity);
    }
}

TEST(Simulation, RefusesCheckpointsOfOtherScenesAndDamagedOnes) {
    Simulation simulation(pendulum());
    simulation.run(5);
    std::string const kept = simulation.checkpoint();
    Simulation other(pendulum().set("dynamics.step", 0.002));
    std::string const said = message_of([&] { other.restore(kept); });
    EXPECT_NE(said.find("dynamics.step was 0.001, now it is 0.002"), std::string::npos) << said;
    std::string damaged = kept;
    damaged[damaged.size() / 2] ^= 1;
    EXPECT_NE(message_of([&] { simulation.restore(damaged); }).find("checksum"), std::string::npos);
    EXPECT_NE(message_of([&] { simulation.restore(kept.substr(0, 22)); }).find("cut off"),
              std::string::npos);
    EXPECT_NE(message_of([&] { simulation.restore("text"); }).find("not a checkpoint"),
              std::string::npos);
    Simulation forced(pendulum(), [](auto const&, auto const&) { return std::nullopt; });
    EXPECT_NE(message_of([&] { forced.restore(kept); }).find("own force"), std::string::npos);
    EXPECT_EQ(simulation.step(), 5);
    EXPECT_EQ(simulation.run(1), 1);
}

// A failed step leaves forces and positions of different times: steps from there would be wrong.
TEST(Simulation, RefusesToGoOnAfterAFailedStep) {
    bool fails = false;
    Simulation simulation(pendulum(), [&](auto const&, auto const&) {
        if (fails) throw std::runtime_error("no");
        return std::optional(0.0);
    });
    simulation.run(3);
    std::string const kept = simulation.checkpoint();
    fails = true;
    EXPECT_THROW(simulation.run(1), std::runtime_error);
    fails = false;
    EXPECT_NE(message_of([&] { simulation.run(1); }).find("failed after step 3"),
              std::string::npos);
    EXPECT_NE(message_of([&] { simulation.state(); }).find("restore"), std::string::npos);
    simulation.restore(kept);
    EXPECT_EQ(simulation.run(7), 7);
    EXPECT_EQ(simulation.step(), 10);
}

TEST(Simulation, RefusesANegativeNumberOfSteps) {
    Simulation simulation(pendulum());
    EXPECT_NE(message_of([&] { simulation.run(-1); }).find("-1"), std::string::npos);
    EXPECT_EQ(simulation.run(0), 0);
}

TEST(Simulation, RefusesAStepThatItsSpringsLeaveUnstable) {
    Joint joint = revolute();
    joint.stiffness = {1e8};
    Model const model = model_of(rods(joint, 3), "rk4", 0.01);
    EXPECT_NE(message_of([&] { Simulation{model}; }).find("dynamics.step"), std::string::npos);
    EXPECT_NE(message_of([&] { static_cast<void>(model.check()); }).find("dynamics.step"),
              std::string::npos);
    EXPECT_EQ(message_of([] { pendulum().check(); }), "");
}

TEST(Simulation, KnowsTheTemperatureWhereThereIsOne) {
    Model thermal(Units::md);
    thermal.add(beads(12)).set("dynamics", "{integrator: g-baoab, step: 0.001, temperature: 300}");
    thermal.set("dynamics.friction", 1);
    EXPECT_TRUE(Simulation(thermal).state().temperature);
    EXPECT_FALSE(Simulation(pendulum()).state().temperature);
}

}  // namespace
}  // namespace catena::test
