// The scan along chains: the way from joint to joint, and the same bits on any number of ranks and
// by the GPU's kernels.
#include <gtest/gtest.h>

#include <bit>

#include "dynamics/joint/revolute_scan.hpp"
#include "kinematics/joint_kinematics.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/scan_space.hpp"

namespace catena::test {
namespace {

template <class Space>
class MovedIn {
  public:
    MovedIn(Scene const& scene, bool pairwise, Communicator const& communicator)
        : groups_(make_groups(scene, Axes::joint, Handles::projected, pairwise, communicator)),
          state_(make_joint_state(*groups_[0], scene)),
          kinematics_(*groups_[0], Space(*executor_), communicator),
          motion_(*groups_[0], HostSpace(*executor_)) {
        kinematics_.evaluate(state_.view(), true, motion_.view());
    }
    ChainGroup const& group() const { return *groups_[0]; }
    JointsView joints() const { return kinematics_.joints().view(); }
    StateView state() { return state_.view(); }
    /// Everything about a body.
    std::vector<double> of(std::int64_t k) const {
        std::vector<double> all;
        auto const add = [&](auto const& v) {
            all.insert(all.end(), std::begin(v.data), std::end(v.data));
        };
        add(motion_.joint_turn[k]);
        add(motion_.orientation[k]);
        add(motion_.omega[k]);
        add(motion_.origin[k]);
        add(motion_.velocity[k]);
        if (group().joints.moving_meeting() && !group().ends.is_last[static_cast<std::size_t>(k)]) {
            add(motion_.r2[k]);
            add(motion_.axes2[k]);
        }
        return all;
    }
    Motion motion(std::int64_t k) const {
        return {as_quaternion(motion_.orientation[k]), motion_.omega[k], motion_.origin[k],
                motion_.velocity[k]};
    }
    /// Without positions, the rest must be the same.
    void expect_the_same_without_positions() {
        MotionFields<HostSpace> bare(*groups_[0], HostSpace(*executor_));
        kinematics_.evaluate(state_.view(), false, bare.view());
        for (std::int64_t k = 0; k < group().size; ++k)
            for (int i = 0; i < 3; ++i) EXPECT_EQ(bare.omega[k][i], motion_.omega[k][i]) << k;
    }

  private:
    std::unique_ptr<Executor> executor_ = serial_executor();
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    JointState state_;
    JointKinematics<Space> kinematics_;
    BodyMotion motion_;
};
using Moved = MovedIn<HostSpace>;

Scene two_chains(RandomJoints joints, std::size_t bodies, Base base) {
    Scene scene;
    scene.chains = {random_chain(bodies, {.bodies = bodies, .joints = joints, .base = base}),
                    random_chain(bodies + 1, {.bodies = 13, .joints = joints, .base = base})};
    return scene;
}

constexpr RandomJoints all_joints[] = {RandomJoints::revolute,  RandomJoints::spherical,
                                       RandomJoints::universal, RandomJoints::weld,
                                       RandomJoints::helical,   RandomJoints::planar,
                                       RandomJoints::any,       RandomJoints::cylindrical,
                                       RandomJoints::planar3,   RandomJoints::all};

TEST(Kinematics, GoesFromJointToJoint) {
    auto const alone = serial_communicator();
    for (RandomJoints const joints : all_joints)
        for (std::size_t const bodies : {1, 2, 7, 8, 9, 16, 65, 513, 1031})
            for (bool const pairwise : {false, true}) {
                Moved moved(two_chains(joints, bodies, Base::free), pairwise, *alone);
                Motion at = Motion::none();
                double const eps = 1e-14 * static_cast<double>(bodies);
                for (std::int64_t k = 0; k < moved.group().size; ++k) {
                    if (moved.group().ends.is_first[static_cast<std::size_t>(k)])
                        at = Motion::none();
                    at = compose<true>(
                        at, moved.joints().motion(moved.state(), k,
                                                  moved.joints().turn_of(moved.state(), k)));
                    at.rotation = normalized(at.rotation);
                    Motion const found = moved.motion(k);
                    EXPECT_NEAR(norm(as_vector(found.rotation) - as_vector(at.rotation)), 0, eps);
                    EXPECT_NEAR(norm(found.omega - at.omega), 0, eps * (1 + norm(at.omega)));
                    EXPECT_NEAR(norm(found.translation - at.translation), 0,
                                eps * (1 + norm(at.translation)));
                    EXPECT_NEAR(norm(found.velocity - at.velocity), 0,
                                eps * (1 + norm(at.velocity) + norm(at.omega)));
                    if (::testing::Test::HasFailure()) FAIL() << "body " << k << " of " << bodies;
                }
                moved.expect_the_same_without_positions();
            }
}

TEST(Kinematics, HasTheSameBitsByTheKernelsOfAGpu) {
    Communicator const& world = catena::testing::world();
    ScanSpace::most_stages = 0;
    auto const expect_the_same = [&](Scene const& scene, std::int64_t most) {
        ScanSpace::most = most;
        ScanSpace::ranks = most > 2 ? &world : nullptr;
        Moved const by_loops(scene, false, world);
        MovedIn<ScanSpace> by_kernels(scene, false, world);
        ScanSpace::most = dca::most_of_scan;
        std::int64_t different = 0;
        for (std::int64_t k = 0; k < by_loops.group().size; ++k)
            different += by_kernels.of(k) != by_loops.of(k) ? 1 : 0;
        EXPECT_EQ(different, 0) << "of " << by_loops.group().size << " bodies, " << most
                                << " items a block";
        by_kernels.expect_the_same_without_positions();
    };
    for (RandomJoints const joints : all_joints)
        for (std::size_t const bodies : {1, 16, 17, 300, 1031, 2000, 5000})
            for (std::int64_t const most : {2, 8, 256})
                if (bodies <= 1031 || (most > 2 && joints == RandomJoints::helical))
                    expect_the_same(
                        two_chains(joints, bodies, bodies % 2 == 0 ? Base::free : Base::fixed),
                        most);
    Scene many;
    for (std::size_t bodies = 1; bodies <= 40; ++bodies)
        many.chains.push_back(random_chain(
            bodies, {.bodies = 3 * bodies, .joints = RandomJoints::revolute, .base = Base::fixed}));
    for (std::int64_t const most : {2, 8, 256}) expect_the_same(many, most);
    EXPECT_EQ(ScanSpace::shared_turns > 0, world.size() > 1);
    if (world.size() > 1) return;
    EXPECT_GE(ScanSpace::most_stages, 6U);
}

/// What a RevoluteScan leaves to solvers and steps, of chains that begin with whatever joint and go
/// on with revolute joints.
template <class Space>
class RevolutesIn {
  public:
    RevolutesIn(Scene const& scene, Communicator const& communicator)
        : groups_(make_groups(scene, Axes::joint, Handles::projected, false, communicator)),
          state_(make_joint_state(*groups_[0], scene)),
          kinematics_(*groups_[0], Space(*executor_), communicator),
          motion_(*groups_[0], HostSpace(*executor_)),
          joint_load_(group().size),
          given_(group().size),
          torque_(group().size),
          inertia_(group().bodies.inertia),
          bias_(group().size + 1, group().directions),
          in_run_(static_cast<std::size_t>(group().size), 0) {
        for (std::int64_t k = 0; k < group().size; ++k)
            given_.view().at(k, 0) = 0.1 * static_cast<double>(k % 7);
        for (dca::Run const& run : group().schedule.runs)
            for (std::int64_t k = run.body; run.count > 1 && k < run.body + run.count; ++k)
                if (!group().ends.is_first[static_cast<std::size_t>(k)])
                    in_run_[static_cast<std::size_t>(k)] =
                        k == run.body ? RevolutesInRuns::first : RevolutesInRuns::within;
    }
    ChainGroup const& group() const { return *groups_[0]; }
    /// The bits of what becomes of every body, each time from another state.
    std::vector<std::uint64_t> find(bool joint_loads, bool all_turns) {
        for (std::int64_t k = 0; k < group().size; ++k) {
            state_.view().qd.at(k, 0) = 1.1 * state_.view().qd.at(k, 0) + 0.01;
            if (group().joints.type[static_cast<std::size_t>(k)] == JointType::revolute)
                state_.view().q.at(k, 0) += 0.3;
        }
        JointLoads loads;
        loads.moved.scan = kinematics_.scan(state_.view(), motion_.view());
        loads.moved.scan.motion.orients_first_alone = true;
        loads.in_run = {in_run_.data()};
        loads.left = {false, true, true};
        loads.given.gravity = {{1, 2, -9.81}};
        loads.directions = group().directions;
        loads.inertia = inertia_.view();
        loads.torque = torque_.view();
        loads.bias = bias_.view();
        loads.moved.fixed_axes2 = group().bodies.axes2.view();
        loads.moved.fixed_r2 = group().bodies.r2.view();
        loads.joint_load = joint_load_.view();
        loads.given.torque = given_.view();
        loads.given.joint_loads = joint_loads;
        RevoluteScan const scan{loads, false, all_turns};
        auto const beside =
            joint_loads ? from_outboard(group(), loads.joint_load) : BodyExchange<4>::none();
        kinematics_.sweep_runs(scan, beside, [scan](dca::Run const& run) { scan.begin(run); });
        std::vector<std::uint64_t> all;
        auto const add = [&](auto const& v) {
            for (double const number : v.data) all.push_back(std::bit_cast<std::uint64_t>(number));
        };
        for (std::int64_t k = 0; k < group().size; ++k) {
            add(kinematics_.rotations().load(k));
            add(motion_.joint_turn[k]);
            add(motion_.orientation[k]);
            add(motion_.omega[k]);
            add(joint_load_.view().load(k));
            add(torque_.view().load(k));
            for (int d = 0; d < group().directions; ++d)
                all.push_back(std::bit_cast<std::uint64_t>(bias_.view().at(k, d)));
        }
        if (joint_loads) add(joint_load_.view().load(group().size));
        return all;
    }

  private:
    std::unique_ptr<Executor> executor_ = serial_executor(SimdLevel::off);
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    JointState state_;
    JointKinematics<Space> kinematics_;
    BodyMotion motion_;
    Field<4> joint_load_;
    Field<3> given_, torque_;
    Field<6> inertia_;
    DirectionsField bias_;
    std::vector<std::uint8_t> in_run_;
};
/// Alone, and where ranks share the chains.
TEST(Kinematics, HasTheSameBitsOfRevolutesByTheKernelsOfAGpu) {
    Communicator const& world = catena::testing::world();
    ScanSpace::shared_turns = 0;
    ScanSpace::ranks = &world;
    auto const expect_the_same = [&](Scene const& scene) {
        RevolutesIn<HostSpace> by_loops(scene, world);
        RevolutesIn<ScanSpace> by_kernels(scene, world);
        for (bool const joint_loads : {false, true})
            for (bool const all_turns : {false, true})
                for (int state = 0; state < 2; ++state)
                    EXPECT_EQ(by_kernels.find(joint_loads, all_turns),
                              by_loops.find(joint_loads, all_turns))
                        << by_loops.group().size;
    };
    for (std::size_t const bodies : {1, 2, 15, 16, 17, 33, 300, 1031, 2048, 4080, 4083, 5000, 9001})
        for (Base const base : {Base::fixed, Base::free})
            expect_the_same(two_chains(RandomJoints::revolute, bodies, base));
    Scene many;
    for (std::size_t bodies = 1; bodies <= 40; ++bodies)
        many.chains.push_back(random_chain(
            bodies, {.bodies = 3 * bodies, .joints = RandomJoints::revolute, .base = Base::fixed}));
    expect_the_same(many);
    EXPECT_EQ(ScanSpace::shared_turns > 0, world.size() > 1);
}

TEST(Kinematics, HasTheSameBitsOnAnyNumberOfRanks) {
    Communicator const& world = catena::testing::world();
    auto const alone = serial_communicator();
    for (RandomJoints const joints : all_joints)
        for (std::size_t const bodies : {9, 65, 513, 1031}) {
            Scene const scene = two_chains(joints, bodies, Base::free);
            Moved const all(scene, false, *alone), part(scene, false, world);
            for (std::int64_t k = 0; k < part.group().size; ++k)
                ASSERT_EQ(part.of(k),
                          all.of(part.group().scene_index(k) - all.group().scene_index(0)))
                    << "body " << k << " of " << bodies;
        }
}

}  // namespace
}  // namespace catena::test
