// Models in memory, their solutions and simulations, against scene files and Catena's own classes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "integrate/stepper.hpp"
#include "reader/load_scene.hpp"
#include "tests/catena/models.hpp"

namespace catena::test {
namespace {

std::string const pendulum =
    "units: si\n"
    "chains:\n"
    "  - name: rods\n"
    "    base: fixed\n"
    "    bodies:\n"
    "      - {mass: 2, com: [0.5, 0, 0], inertia: [0.1, 0.5, 0.6], joint: {type: revolute, axis: "
    "[0, 1, 0], q: 0.3}}\n"
    "      - {mass: 2, com: [0.5, 0, 0], inertia: [0.1, 0.5, 0.6], joint: {type: revolute, axis: "
    "[0, 1, 0], q: 0.3, translation: [1, 0, 0]}}\n"
    "forces: {gravity: [0, 0, -9.81]}\n"
    "dynamics: {integrator: rk4, step: 0.001}\n";

Model pendulum_in_memory() {
    return model_of(rods(revolute(), 2), "rk4", 0.001).set("forces.gravity", "[0, 0, -9.81]");
}

std::string message_of(auto const& action) {
    try {
        action();
    } catch (Error const& error) {
        return error.what();
    }
    return "";
}

TEST(Model, InMemoryHasTheBitsOfTheSameSceneInYaml) {
    Model const memory = pendulum_in_memory(), text = Model::from_text(pendulum);
    SolverResult const a = Solver(memory).solve(), b = Solver(text).solve();
    EXPECT_TRUE(a.valid());
    EXPECT_EQ(a.joint_acceleration, b.joint_acceleration);
    EXPECT_EQ(a.joint_force[1].force, b.joint_force[1].force);
    Simulation one(memory), other(text);
    one.run(300);
    other.run(300);
    EXPECT_EQ(one.state().position, other.state().position);
    EXPECT_EQ(one.state().joint_position, other.state().joint_position);
    EXPECT_EQ(one.state().total_energy(), other.state().total_energy());
}

TEST(Model, StepsHaveTheBitsOfTheStepper) {
    Simulation simulation(Model::from_text(pendulum));
    simulation.run(300);
    auto const alone = serial_communicator();
    Scene const scene = parse_scene(pendulum, "pendulum");
    ChainSystem system(scene, Axes::joint, *alone);
    auto const stepper = make_stepper(system, scene.dynamics);
    for (std::int64_t n = 0; n < 300; ++n) {
        stepper->prepare(nullptr);
        stepper->step(n, nullptr);
    }
    SceneMotion const at = system.snapshot();
    SimulationState const state = simulation.state();
    EXPECT_EQ(state.step, 300);
    for (std::size_t k = 0; k < 2; ++k)
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(state.position[k][static_cast<std::size_t>(i)], at.position[k][i]);
            EXPECT_EQ(state.velocity[k][static_cast<std::size_t>(i)], at.velocity[k][i]);
        }
}

// The joint at the ground holds what gravity and the rods' accelerations leave.
TEST(Solver, JointForcesObeyNewtonsLaw) {
    SolverResult const found = Solver(pendulum_in_memory()).solve();
    double force = 0;
    for (Triple const& a : found.acceleration) force += 2 * (a[2] + 9.81);
    EXPECT_NEAR(found.joint_force[0].force[2], force, 1e-12 * 40);
    ASSERT_TRUE(found.error);
    EXPECT_LE(*found.error, found.error_bound);
}

TEST(Simulation, KnowsItsTimeAndClosedJoints) {
    Simulation simulation(model_of(beads(12), "rattle", 0.01));
    EXPECT_EQ(simulation.time(), 0);
    simulation.run(40);
    simulation.run(10);
    EXPECT_EQ(simulation.step(), 50);
    EXPECT_DOUBLE_EQ(simulation.time(), 0.5);
    EXPECT_LE(simulation.state().constraint_error, 1e-10);
}

TEST(Model, SaysWhatTheProgramSays) {
    Chain chain = rods(revolute(), 2);
    chain.bodies[1].mass = -1;
    std::string const mass = message_of([&] { Model().add(chain).bodies(); });
    EXPECT_NE(mass.find("scene in memory: chains[0].bodies[1].mass, body 2"), std::string::npos)
        << mass;
    Model model;
    model.add(rods(revolute(), 1));
    std::string const dynamics = message_of([&] { Simulation{model}; });
    EXPECT_NE(dynamics.find("no dynamics section"), std::string::npos) << dynamics;
    std::string const key =
        message_of([&] { model.set("forces.gravitation", "[0, 0, 1]").bodies(); });
    EXPECT_NE(key.find("gravity"), std::string::npos) << key;
}

TEST(Model, RefusesWhatItCannotTake) {
    Model text = Model::from_text(pendulum);
    EXPECT_NE(message_of([&] { text.add(beads(3)); }), "");
    Chain both = beads(3);
    both.bodies.push_back(rod());
    EXPECT_NE(message_of([&] { Model().add(both); }), "");
    EXPECT_NE(message_of([] { Model::from_file("no-such-scene.yaml"); }), "");
    try {
        Model().bodies();
        FAIL() << "a scene without chains was accepted";
    } catch (Error const& error) {
        EXPECT_EQ(error.reason(), Error::Reason::input);
    }
}

TEST(Model, IsCopiedWithItsChains) {
    Model const first = pendulum_in_memory();
    Model second = first;
    Chain more = rods(revolute(), 3);
    more.name = "more";
    second.add(more);
    EXPECT_EQ(first.bodies(), 2);
    EXPECT_EQ(second.bodies(), 5);
}

/// Branched beads in memory are those of the same scene in YAML, and own forces see them in order.
TEST(Model, TakesBranchesOfBeads) {
    Chain star = beads(4);
    star.beads[2].parent = 1;
    star.beads[3].parent = 1;
    Model const memory = model_of(star, "rattle", 0.001);
    Model const text = Model::from_text(
        "units: si\n"
        "chains: [{name: beads, bodies: [{mass: 1, position: [0, 0, 0], velocity: [0, 0, 0.1]}, "
        "{mass: 1.1, position: [0.8, 0.6, 0], velocity: [0, 0, -0.1], joint: {type: link}}, "
        "{mass: 1.2, position: [1.6, 0, 0], velocity: [0, 0, -0.1], parent: 1, joint: {type: "
        "link}}, {mass: 1.3, position: [2.4000000000000004, 0.6, 0], velocity: [0, 0, 0.1], "
        "parent: 1, joint: {type: link}}]}]\n"
        "dynamics: {integrator: rattle, step: 0.001}\n");
    SolverResult const a = Solver(memory).solve(), b = Solver(text).solve();
    EXPECT_TRUE(a.valid());
    EXPECT_EQ(a.joint_acceleration, b.joint_acceleration);
    std::vector<Triple> seen;
    Simulation const simulation(memory, [&](auto const& at, auto const&) {
        seen.assign(at.position.begin(), at.position.end());
        return std::nullopt;
    });
    ASSERT_EQ(seen.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(seen[k][0], star.beads[k].position[0], 1e-14);
}

/// Branched bodies in memory are those of the same scene in YAML.
TEST(Model, TakesBranchesOfBodies) {
    Joint const joint{.type = "revolute", .axis = Triple{0, 0, 1}, .translation = {1, 0, 0}};
    Body const body{.mass = 1, .inertia = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .joint = joint};
    Chain tree{.name = "tree", .bodies = {body, body, body}, .fixed_base = true};
    tree.bodies[2].parent = 1;
    Model memory(Units::si);
    memory.add(tree).set("forces.gravity", "[0, -9.81, 0]");
    std::string const hanging =
        "{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1], translation: [1, "
        "0, 0]}";
    Model const text = Model::from_text("units: si\nchains: [{name: tree, base: fixed, bodies: [" +
                                        hanging + "}, " + hanging + "}, " + hanging +
                                        ", parent: 1}]}]\nforces: {gravity: [0, -9.81, 0]}\n");
    SolverResult const a = Solver(memory).solve(), b = Solver(text).solve();
    EXPECT_TRUE(a.valid());
    EXPECT_EQ(a.joint_acceleration, b.joint_acceleration);
    EXPECT_EQ(a.joint_acceleration[1], a.joint_acceleration[2]);
}

/// The random tree of tests/data/reference/beadtree20.json: accelerations and tensions that were
/// computed to 50 digits by other means.
TEST(Solver, HasTheAccelerationsOfAThirdPartysTree) {
    std::ifstream file(std::string(CATENA_TEST_DATA) + "/reference/beadtree20.json");
    nlohmann::json const json = nlohmann::json::parse(file), &expected = json.at("expected");
    Chain tree{.name = "tree"};
    for (std::size_t k = 0; k < json.at("mass").size(); ++k) {
        tree.beads.push_back({.mass = json.at("mass").at(k),
                              .position = json.at("position").at(k),
                              .velocity = json.at("velocity").at(k).get<Triple>()});
        if (k > 0) tree.beads.back().parent = json.at("parent").at(k).get<std::int64_t>();
    }
    auto const force = json.at("force").get<std::vector<Triple>>();
    SolverResult const found =
        Solver(model_of(tree, "rattle", 0.001), [&](BodyPositions const&, BodyForces const& on) {
            std::copy(force.begin(), force.end(), on.force.begin());
            return std::nullopt;
        }).solve();
    double error = 0, largest = 0, of_tensions = 0, largest_tension = 0;
    for (std::size_t k = 0; k < tree.beads.size(); ++k) {
        Triple const right = expected.at("acceleration").at(k);
        for (std::size_t i = 0; i < 3; ++i) {
            error = std::max(error, std::abs(found.acceleration[k][i] - right[i]));
            largest = std::max(largest, std::abs(right[i]));
        }
        Triple const& pull = found.joint_force[k].force;
        double const tension = expected.at("tension").at(k);
        double const size = std::hypot(pull[0], pull[1], pull[2]);
        of_tensions = std::max(of_tensions, std::abs(size - std::abs(tension)));
        largest_tension = std::max(largest_tension, std::abs(tension));
    }
    EXPECT_TRUE(found.valid());
    EXPECT_LE(error, 1e-13 * largest);
    EXPECT_LE(of_tensions, 1e-13 * largest_tension);
    std::printf("accelerations %.1e, tensions %.1e\n", error / largest,
                of_tensions / largest_tension);
}

TEST(Model, TakesEveryMemberOfAJoint) {
    Joint joint = revolute();
    joint.q = {0.2};
    joint.qd = {0.1};
    joint.torque = {0.5};
    joint.stiffness = {15};
    joint.damping = {0.2};
    joint.rest = {0.5};
    joint.rotation = std::array<Triple, 3>{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    Chain free{.name = "free", .bodies = {rod()}};
    free.bodies[0].joint =
        Joint{.type = "free", .q = {1, 2, 3, 1, 0, 0, 0}, .qd = {0.1, 0, 0, 0, 0, 0.5}};
    Joint const universal{.type = "universal", .axes = {{1, 0, 0}, {0, 1, 0}}, .q = {0.1, 0.2}};
    Joint const helical{.type = "helical", .axis = Triple{0, 0, 1}, .pitch = 0.1};
    Model model = model_of(rods(joint, 1), "rk4", 0.001);
    model.add(free);
    for (Joint const& other : {universal, helical}) {
        Chain chain = rods(other, 2);
        chain.name = other.type;
        model.add(chain);
    }
    SimulationState const state = Simulation(model).state();
    ASSERT_EQ(state.position.size(), 6u);
    EXPECT_EQ(state.joint_position[0][0], 0.2);
    EXPECT_EQ(state.joint_rate[0][0], 0.1);
    EXPECT_EQ(state.position[1], (Triple{1.5, 2, 3}));
    EXPECT_DOUBLE_EQ(state.potential_energy[1].second, 0.5 * 15 * 0.3 * 0.3);
}

}  // namespace
}  // namespace catena::test
