#include "force/worker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "tests/force/beads.hpp"

namespace catena::testing {
namespace {

TEST(Worker, RunsTasksInTurnOnAThreadOfItsOwn) {
    Worker worker;
    std::thread::id first, second;
    int sum = 0;
    worker.wait();  // nothing to wait for
    worker.post([&] { first = std::this_thread::get_id(), sum += 1; });
    worker.wait();
    worker.post([&] { second = std::this_thread::get_id(), sum *= 10; });
    worker.wait();
    EXPECT_EQ(sum, 10);
    EXPECT_EQ(first, second);
    EXPECT_NE(first, std::this_thread::get_id());
}

TEST(Worker, PostReturnsWhileTheTaskRuns) {
    Worker worker;
    std::atomic<bool> go{false}, done{false};
    worker.post([&] {
        while (!go) std::this_thread::yield();
        done = true;
    });
    EXPECT_FALSE(done);
    go = true;
    worker.wait();
    EXPECT_TRUE(done);
}

TEST(Worker, EndsAfterItsLastTask) {
    std::atomic<int> done{0};
    for (int i = 0; i < 50; ++i) {
        Worker worker;
        worker.post([&] { ++done; });
    }
    EXPECT_EQ(done, 50);
}

class Trouble : public ::testing::TestWithParam<std::string> {};

/// What goes wrong on the worker comes out of finish(), and the next evaluation is unharmed.
TEST_P(Trouble, ComesOutOfFinish) {
    auto const serial = serial_communicator();
    BeadSystem const beads = proteins({"KDEKDE"});
    OpenMmSpec spec = on_reference();
    spec.path = GetParam();
    auto const force = make_openmm_force(spec, beads, *serial);
    EXPECT_EQ(force->path(), GetParam());
    auto const positions = wound(beads, 1);
    auto const good = evaluate(*force, positions);
    auto bad = positions;
    bad[3][1] = std::numeric_limits<double>::quiet_NaN();

    Field<3> given(beads.size()), forces(beads.size());
    for (std::int64_t k = 0; k < beads.size(); ++k) given.set(k, bad[k]);
    force->begin(std::as_const(given).view());
    try {
        force->finish(forces.view());
        ADD_FAILURE() << "nothing was thrown";
    } catch (ComputationError const& e) {
        EXPECT_STREQ(e.what(),
                     "the position of bead 4 is not finite: use a smaller dynamics.step, or a "
                     "start without overlaps");
    }
    EXPECT_EQ(norm(forces[0]), 0);
    EXPECT_EQ(difference(evaluate(*force, positions), good), 0);

    bad = positions;
    bad[2] = bad[0];  // on top of each other
    for (std::int64_t k = 0; k < beads.size(); ++k) given.set(k, bad[k]);
    force->begin(std::as_const(given).view());
    EXPECT_THROW(force->finish(forces.view()), ComputationError);
    EXPECT_EQ(difference(evaluate(*force, positions), good), 0);
}

TEST_P(Trouble, CallsOutOfTurn) {
    auto const serial = serial_communicator();
    BeadSystem const beads = proteins({"KDEKDE"});
    OpenMmSpec spec = on_reference();
    spec.path = GetParam();
    auto const force = make_openmm_force(spec, beads, *serial);
    Field<3> forces(beads.size());
    EXPECT_THROW(force->finish(forces.view()), ComputationError);
    EXPECT_THROW(force->energies(), ComputationError);
    evaluate(*force, wound(beads, 1));
    EXPECT_THROW(force->finish(forces.view()), ComputationError);
}

TEST_P(Trouble, NoneWhenNobodyTakesTheForces) {
    auto const serial = serial_communicator();
    BeadSystem const beads = proteins({random_sequence(50, 1)});
    OpenMmSpec spec = on_reference();
    spec.path = GetParam();
    auto const force = make_openmm_force(spec, beads, *serial);
    Field<3> positions(beads.size());
    auto const x = wound(beads, 1);
    for (std::int64_t k = 0; k < beads.size(); ++k) positions.set(k, x[k]);
    force->begin(std::as_const(positions).view());  // and the destructor waits
}

TEST_P(Trouble, TheIntervalIsThatOfTheEvaluation) {
    auto const serial = serial_communicator();
    BeadSystem const beads = proteins({random_sequence(50, 1)});
    OpenMmSpec spec = on_reference();
    spec.path = GetParam();
    auto const force = make_openmm_force(spec, beads, *serial);
    evaluate(*force, wound(beads, 1));
    auto const one = force->last_evaluation();
    evaluate(*force, wound(beads, 1));
    auto const two = force->last_evaluation();
    EXPECT_LT(one.begin, one.end);
    EXPECT_LE(one.end, two.begin);
    EXPECT_LT(two.begin, two.end);
}

INSTANTIATE_TEST_SUITE_P(On, Trouble, ::testing::Values("host", "inline"),
                         [](auto const& i) { return i.param; });

}  // namespace
}  // namespace catena::testing
