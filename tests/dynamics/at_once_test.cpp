// Matrices and biases in one sweep: as good a solution as by one sweep after the other, and the
// same one.
#include <gtest/gtest.h>

#include "integrate/chain_system.hpp"
#include "math/simd_level.hpp"
#include "reader/load_scene.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/pulled.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

struct Case {
    char const* name;
    char const* chains;
    bool is_pulled = false;
};
Case const cases[] = {
    {"free_beads",
     "{velocities: thermal, generator: {freely_jointed: {beads: 333, length: 0.38}}}"},
    {"short_runs", "{velocities: thermal, generator: {freely_jointed: {beads: 17, length: 0.38}}}"},
    {"one_bead", "{velocities: thermal, generator: {freely_jointed: {beads: 1, length: 0.38}}}"},
    {"hanging_beads",
     "{base: fixed, velocities: thermal, generator: {random: {bodies: 200, joint: link, seed: "
     "2}}}"},
    {"held_beads",
     "{base: fixed, velocities: thermal, tip: {joint: {type: link, anchor: [2, 3, 1]}}, generator: "
     "{freely_jointed: {beads: 70, length: "
     "0.38}}}"},
    {"many_beads",
     "{count: 5, velocities: thermal, generator: {freely_jointed: {beads: 23, length: 0.38}}}, "
     "{velocities: thermal, generator: "
     "{freely_jointed: {beads: 129, length: 0.38}}}"},
    {"pulled_beads",
     "{velocities: thermal, generator: {freely_jointed: {beads: 333, length: 0.38}}}", true},
    {"free_bodies",
     "{base: free, velocities: thermal, generator: {random: {bodies: 301, joint: spherical, seed: "
     "1}}}"},
    {"hanging_bodies",
     "{base: fixed, velocities: thermal, generator: {random: {bodies: 50, joint: spherical, seed: "
     "4}}}"},
    {"held_bodies",
     "{base: free, velocities: thermal, tip: {joint: {type: spherical}}, generator: {random: "
     "{bodies: 40, joint: spherical, seed: 3}}}"},
    {"bodies_on_links",
     "{velocities: thermal, generator: {random: {bodies: 60, joint: link, rigid: 0.5, seed: 8}}}"},
};

class AtOnce : public ::testing::TestWithParam<Case> {
  protected:
    static Scene scene(Backend backend) {
        Scene s = parse_scene(std::string("chains: [") + GetParam().chains +
                                  "]\nforces: {gravity: [1, 2, -9.81]}\ndynamics: {integrator: "
                                  "rattle, step: 0.002, temperature: 300, seed: 5}",
                              "scene.yaml");
        s.solver.backend = backend;
        return GetParam().is_pulled ? pulled(std::move(s)) : s;
    }
};

void move(ChainSystem& system) {
    system.evaluate();
    for (AbsoluteDynamics* const group : system.absolute())
        group->draw_velocities(2.5, 7, std::vector<bool>(system.scene().chains.size(), true));
}

double largest(std::vector<Vec3> const& a) {
    double most = 0;
    for (Vec3 const& v : a) most = std::max(most, norm(v));
    return most;
}

std::vector<Vec3> halves(std::vector<Vector<double, 6>> const& wrenches) {
    std::vector<Vec3> all;
    for (auto const& w : wrenches)
        all.insert(all.end(), {Vec3{{w[0], w[1], w[2]}}, Vec3{{w[3], w[4], w[5]}}});
    return all;
}

/// Ranks may not matter to a bit; how the sweeps are put together matters in the last ones, which a
/// chain of n bodies lets grow like n.
TEST_P(AtOnce, IsTheSolution) {
    for (Backend const backend : {Backend::serial, Backend::segments}) {
        Scene const s = scene(backend);
        ChainSystem system(s, Axes::world, testing::world());
        move(system);
        system.evaluate();
        ChainSystem::Accelerations const apart = system.accelerations();
        system.evaluate(false);
        EXPECT_LE(system.residual(), system.residual_bound());
        ChainSystem::Accelerations const at_once = system.accelerations();
        double const tolerance = 64 * static_cast<double>(s.bodies()) * 0x1p-53;
        ASSERT_EQ(apart.acceleration.size(), at_once.acceleration.size());
        for (std::size_t k = 0; k < apart.acceleration.size(); ++k)
            EXPECT_LE(norm(apart.acceleration[k] - at_once.acceleration[k]),
                      tolerance * largest(apart.acceleration))
                << "body " << k;
        if (testing::world().rank() > 0) continue;
        auto const one_rank = serial_communicator();
        ChainSystem alone(s, Axes::world, *one_rank);
        move(alone);
        alone.evaluate();
        alone.evaluate(false);
        EXPECT_TRUE(same_bits(alone.accelerations().acceleration, at_once.acceleration));
        EXPECT_TRUE(same_bits(alone.accelerations().joint_force, at_once.joint_force));
    }
}

/// In joint coordinates: by the residual, and the same on one rank and on all.
TEST(AtOnceInJoints, IsASolution) {
    for (char const* const joint : {"planar", "spherical", "universal", "revolute", "helical",
                                    "mixed", "weld", "cylindrical", "planar3"})
        for (int const bodies : {1, 5, 16, 70, 333})
            for (char const* const tip : {"", ", tip: {joint: {type: spherical}}"}) {
                if (*tip &&
                    (bodies < 5 || joint == std::string("planar") || joint == std::string("weld")))
                    continue;
                SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies) + tip);
                Scene s = parse_scene(
                    std::string("chains: [{base: fixed, generator: {random: {seed: 3, joint: ") +
                        joint + ", bodies: " + std::to_string(bodies) + "}}" + tip +
                        "}]\nforces: {gravity: [1, 2, -9.81]}",
                    "scene.yaml");
                s.solver.backend = Backend::segments;
                ChainSystem system(s, Axes::joint, testing::world());
                system.evaluate(false);
                EXPECT_LE(system.residual(), system.residual_bound());
                ChainSystem::Accelerations const at_once = system.accelerations();
                if (testing::world().rank() > 0) continue;
                auto const one_rank = serial_communicator();
                ChainSystem alone(s, Axes::joint, *one_rank);
                alone.evaluate(false);
                EXPECT_TRUE(same_bits(alone.accelerations().joint_acceleration,
                                      at_once.joint_acceleration));
                EXPECT_TRUE(same_bits(alone.accelerations().joint_force, at_once.joint_force));
            }
}

/// Whose first body then has two revolute joints, and meets the ground where that moves.
void begin_on_universal(BodyArrays& b) {
    b.joint[0] = JointType::universal;
    if (b.first_axis.empty()) b.first_axis.assign(b.joint.size(), Vec3{{1, 0, 0}});
    Vec3 const across = cross(b.axis[0], Vec3{{1, 2, 3}});
    b.first_axis[0] = (1 / norm(across)) * across;
}
/// What chains on revolute joints leave to their solver, and take from it, is what bodies' loads
/// and accelerations say; no rank matters to a bit.
TEST(RevoluteChains, MayLeaveTheirLoadsToTheSolver) {
    struct Loads {
        char const* name;
        void (*set)(BodyArrays&);  // beside random torques and wrenches
    };
    Vec3 static const ones{{1, 2, 3}};
    Loads const loads[] = {
        {"as they are", [](BodyArrays&) {}},
        {"dampers", [](BodyArrays& b) { b.damping.assign(b.joint.size(), ones); }},
        {"more wrenches", [](BodyArrays& b) { b.wrench.assign(b.joint.size(), {ones, ones}); }},
        {"torques alone", [](BodyArrays& b) { b.wrench.clear(); }},
        {"wrenches alone", [](BodyArrays& b) { b.torque.clear(); }},
        {"none", [](BodyArrays& b) { b.wrench.clear(), b.torque.clear(); }},
        {"springs and dampers", [](BodyArrays& b) {
             b.wrench.clear(), b.torque.clear();
             b.stiffness.assign(b.joint.size(), ones), b.damping.assign(b.joint.size(), ones);
         }}};
    for (char const* const base : {"base: free, ", "base: fixed, ", "universal"}) {
        bool const on_universal = base == std::string("universal");
        for (auto const& [bodies, next] : std::vector<std::pair<int, int>>{{1, 16},
                                                                           {2, 17},
                                                                           {4, 5},
                                                                           {9, 15},
                                                                           {16, 33},
                                                                           {17, 1},
                                                                           {35, 35},
                                                                           {70, 2},
                                                                           {333, 129}})
            for (Loads const& of : loads) {
                SCOPED_TRACE(std::string(base) + std::to_string(bodies) + ", " +
                             std::to_string(next) + ", " + of.name);
                auto const chain = [&](int seed, int length) {
                    return std::string("{") + (on_universal ? "base: fixed, " : base) +
                           "generator: {random: {seed: " + std::to_string(seed) +
                           ", joint: revolute, bodies: " + std::to_string(length) + "}}}";
                };
                std::string const chains =
                    chain(3, bodies) + ", " + chain(4, next) + ", " + chain(5, 40);
                Scene s = parse_scene("chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}",
                                      "scene.yaml");
                for (ChainSpec& spec : s.chains) {
                    of.set(spec.bodies);
                    if (on_universal) begin_on_universal(spec.bodies);
                }
                s.solver.backend = Backend::segments;
                auto const accelerations = [&](Communicator const& communicator, bool leaves) {
                    ChainSystem system(s, Axes::joint, communicator);
                    bool by_revolutes = false;  // a chain of one body is of another group
                    for (JointDynamics* const group : system.joint()) {
                        by_revolutes = by_revolutes || group->solver().eliminates_revolute_joints();
                        leaves ? group->update_to_solve_once() : group->update_configuration();
                        group->solve_once();
                        group->set_rates();
                    }
                    EXPECT_TRUE(by_revolutes);
                    EXPECT_LE(system.residual(), system.residual_bound());
                    return system.accelerations();
                };
                auto const left = accelerations(testing::world(), true),
                           told = accelerations(testing::world(), false);
                double const tolerance = 64 * static_cast<double>(s.bodies()) * 0x1p-53;
                auto const expect_near = [tolerance](std::vector<Vec3> const& a,
                                                     std::vector<Vec3> const& b, char const* what) {
                    ASSERT_EQ(a.size(), b.size());
                    for (std::size_t k = 0; k < a.size(); ++k)
                        EXPECT_LE(norm(a[k] - b[k]), tolerance * largest(b)) << what << k;
                };
                expect_near(left.joint_acceleration, told.joint_acceleration, "joint ");
                expect_near(left.base_acceleration, told.base_acceleration, "base ");
                expect_near(left.acceleration, told.acceleration, "body ");
                expect_near(left.alpha, told.alpha, "turning body ");
                expect_near(halves(left.joint_force), halves(told.joint_force), "joint force ");
                if (testing::world().rank() > 0) continue;
                auto const alone = accelerations(*serial_communicator(), true);
                EXPECT_TRUE(same_bits(alone.joint_acceleration, left.joint_acceleration));
                EXPECT_TRUE(same_bits(alone.base_acceleration, left.base_acceleration));
                EXPECT_TRUE(same_bits(alone.joint_force, left.joint_force));
                if (!rounds_as_vectors()) continue;
                s.solver.simd = SimdLevel::off;
                auto const one_by_one = accelerations(*serial_communicator(), true);
                EXPECT_TRUE(same_bits(one_by_one.joint_acceleration, left.joint_acceleration));
                EXPECT_TRUE(same_bits(one_by_one.joint_force, left.joint_force));
            }
    }
}
/// Whatever is asked for after a step, and how often.
TEST(RevoluteChains, AreFoundAsOftenAsTheyAreAskedFor) {
    for (SimdLevel const level : simd_levels()) {
        SCOPED_TRACE(name_of(level));
        Scene s = parse_scene(
            "chains: [{base: fixed, generator: {random: {seed: 3, joint: revolute, bodies: 51}}}]",
            "scene.yaml");
        s.solver.backend = Backend::segments;
        s.solver.simd = level;
        begin_on_universal(s.chains.front().bodies);
        ChainSystem system(s, Axes::joint, testing::world());
        JointDynamics& group = *system.joint().front();
        group.update_to_solve_once();
        group.motion();
        group.solve_once();
        group.set_rates();
        ChainSystem::Accelerations const after_motion = system.accelerations();
        system.evaluate(false);
        ChainSystem::Accelerations const once = system.accelerations();
        EXPECT_TRUE(same_bits(after_motion.joint_acceleration, once.joint_acceleration));
        EXPECT_LE(system.residual(), system.residual_bound());
        EXPECT_LE(system.residual(), system.residual_bound());
        group.motion();
        EXPECT_TRUE(same_bits(system.accelerations().joint_acceleration, once.joint_acceleration));
        EXPECT_TRUE(same_bits(system.accelerations().joint_force, once.joint_force));
        system.evaluate();
        EXPECT_LE(system.residual(), system.residual_bound());
        system.evaluate(false);
        EXPECT_TRUE(same_bits(system.accelerations().joint_acceleration, once.joint_acceleration));
        system.refine();
        EXPECT_LE(system.residual(), system.residual_bound());
        system.evaluate(false);
        EXPECT_LE(system.residual(), system.residual_bound());
    }
}

/// A drift that goes on by single sweeps is the drift with as many of them.
TEST_P(AtOnce, DriftsGoOnByASweep) {
    constexpr double h = 0.002;
    for (Backend const backend : {Backend::serial, Backend::segments}) {
        Scene const s = scene(backend);
        ChainSystem system(s, Axes::world, catena::testing::world());
        move(system);
        for (AbsoluteDynamics* const group : system.absolute()) group->update_configuration();
        system.forces_and_matrices(nullptr);
        for (AbsoluteDynamics* const group : system.absolute()) {
            auto const begin = [&](int sweeps) {
                group->kick(h);
                group->drift(h, sweeps);
            };
            auto const start = group->state();
            begin(3);
            double const error = group->constraint_error();
            auto const expected = group->state();
            group->set_state(start);
            group->update_configuration();
            begin(1);
            for (int further = 0; further < 2; ++further) {
                group->constraint_error();
                if (!group->close_further(h)) {
                    EXPECT_FALSE(group->group().beads);
                    break;
                }
            }
            if (!group->group().beads) continue;
            EXPECT_EQ(group->constraint_error(), error);
            auto const found = group->state();
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i)
                EXPECT_EQ(found[i].values, expected[i].values) << found[i].name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Chains, AtOnce, ::testing::ValuesIn(cases),
                         [](auto const& each) { return each.param.name; });

}  // namespace
}  // namespace catena::test
