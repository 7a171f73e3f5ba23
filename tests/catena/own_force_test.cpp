// Forces by callback: against the built-in ones, on every kind of chain; their energy; refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/catena/models.hpp"

namespace catena::test {
namespace {

constexpr double gravity = -9.81;

/// Returns the weight of bodies of equal mass, with its energy.
OwnForce weight(double mass) {
    return [mass](BodyPositions const& at, BodyForces const& on) {
        double energy = 0;
        for (std::size_t k = 0; k < at.position.size(); ++k) {
            on.force[k][2] += mass * gravity;
            energy -= mass * gravity * at.position[k][2];
        }
        return energy;
    };
}

/// Chains of each kind of dynamics. All masses are 2.
struct Case {
    Chain chain;
    std::string integrator;
};
std::vector<Case> cases() {
    Chain links = beads(6), bodies{.name = "linked"};
    for (Bead& bead : links.beads) bead.mass = 2;
    for (int k = 0; k < 4; ++k) {
        Body body = rod({});
        body.keys["position"] = "[" + std::to_string(2 * k) + ", 0, 0]";
        if (k > 0) body.keys["joint"] = "{type: link, translation: [1, 0, 0]}";
        bodies.bodies.push_back(body);
    }
    return {{rods(revolute(), 4), "rk4"},
            {rods(revolute(), 4), "velocity-verlet"},
            {rods(revolute(), 4), "dormand-prince"},
            {rods(spherical(), 3), "rk4"},
            {rods(spherical(), 3), "rattle"},
            {links, "rattle"},
            {bodies, "rattle"}};
}

// Rods turn by about a radian. Positions of points are rounded to 2^-53 of 4 m; over 100 steps the
// difference stays far below 1e-11 m.
TEST(OwnForce, WeightMovesEveryKindOfChainAsGravityDoes) {
    for (Case const& each : cases()) {
        Model model = model_of(each.chain, each.integrator, 0.005);
        if (each.integrator == "dormand-prince") model.set("dynamics.tolerance", 1e-12);
        Simulation own(model, weight(2));
        Simulation built_in(model.set("forces.gravity", "[0, 0, -9.81]"));
        own.run(100);
        built_in.run(100);
        SimulationState const a = own.state(), b = built_in.state();
        double const scale = std::abs(b.kinetic_energy) + 1;
        for (std::size_t k = 0; k < a.position.size(); ++k)
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_NEAR(a.position[k][i], b.position[k][i], 1e-11) << each.integrator;
                EXPECT_NEAR(a.velocity[k][i], b.velocity[k][i], 1e-10) << each.integrator;
                EXPECT_NEAR(a.joint_force[k].force[i], b.joint_force[k].force[i], 1e-9 * scale)
                    << each.integrator << ", body " << k + 1;
            }
        EXPECT_NE(b.kinetic_energy, 0);
        EXPECT_NEAR(a.total_energy(), b.total_energy(), 1e-10 * scale) << each.integrator;
        EXPECT_EQ(a.potential_energy.back().first, "own force");
    }
}

TEST(OwnForce, TorquesAndForcesAccelerateAsAWrenchDoes) {
    Triple const torque{1, -2, 3}, force{4, 5, -6};
    for (Joint const& joint : {revolute(), spherical()}) {
        Chain chain = rods(joint, 3);
        SolverResult const own =
            Solver(model_of(chain, "rk4", 0.01), [&](auto const&, auto const& on) {
                on.force[2] = force;
                on.torque[2] = torque;
                return std::nullopt;
            }).solve();
        chain.bodies[2].keys["wrench"] = "{torque: [1, -2, 3], force: [4, 5, -6]}";
        SolverResult const wrench = Solver(model_of(chain, "rk4", 0.01)).solve();
        EXPECT_TRUE(own.valid());
        for (std::size_t i = 0; i < own.joint_acceleration.size(); ++i)
            EXPECT_NEAR(own.joint_acceleration[i], wrench.joint_acceleration[i], 1e-11);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(own.joint_force[k].torque[i], wrench.joint_force[k].torque[i], 1e-11);
    }
}

TEST(OwnForce, SeesBodiesAndBeadsInTheOrderOfTheScene) {
    Model model = model_of(rods(spherical(), 2), "rattle", 0.01);
    model.add(beads(3));
    std::vector<Triple> position;
    std::vector<UnitQuaternion> orientation;
    Simulation simulation(model, [&](auto const& at, auto const&) {
        position.assign(at.position.begin(), at.position.end());
        orientation.assign(at.orientation.begin(), at.orientation.end());
        return std::nullopt;
    });
    SimulationState const state = simulation.state();
    ASSERT_EQ(position.size(), 5u);
    for (std::size_t k = 0; k < 5; ++k) {
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(position[k][i], state.position[k][i], 1e-14);
        double same = 0;
        for (std::size_t i = 0; i < 4; ++i) same += orientation[k][i] * state.orientation[k][i];
        EXPECT_NEAR(std::abs(same), 1, 1e-14);
    }
    EXPECT_NE(state.potential_energy.back().first, "own force");
}

/// Springs between beads two places apart, in a model in units of 1.
OwnForce springs() {
    return [](BodyPositions const& at, BodyForces const& on) {
        double energy = 0;
        for (std::size_t k = 0; k + 2 < at.position.size(); ++k)
            for (std::size_t i = 0; i < 3; ++i) {
                double const d = at.position[k + 2][i] - at.position[k][i];
                on.force[k][i] += 3 * d;
                on.force[k + 2][i] -= 3 * d;
                energy += 1.5 * d * d;
            }
        return energy;
    };
}

/// Largest deviation of the energy from the start's in a run of 4 time units.
double energy_error(double step) {
    Simulation simulation(model_of(beads(10), "rattle", step), springs());
    double const start = simulation.state().total_energy();
    double worst = 0;
    for (int i = 0; i < 40; ++i) {
        simulation.run(std::lround(0.1 / step));
        worst = std::max(worst, std::abs(simulation.state().total_energy() - start));
    }
    EXPECT_GT(simulation.state().kinetic_energy, 0.1 * start);
    return worst / start;
}

// RATTLE has order 2: half a step, a quarter of the error.
TEST(OwnForce, SpringsConserveTheEnergyOfAChainOfBeads) {
    double const coarse = energy_error(0.01), fine = energy_error(0.005);
    EXPECT_LE(fine, 1e-3);
    EXPECT_NEAR(coarse / fine, 4, 1);
}

std::string refusal(Model const& model, OwnForce const& force) {
    try {
        Simulation(model, force).run(1);
    } catch (Error const& error) {
        return error.what();
    }
    return "";
}
OwnForce nothing() {
    return [](auto const&, auto const&) { return std::nullopt; };
}

TEST(OwnForce, IsRefusedWhereItCannotAct) {
    Model const chain = model_of(beads(4), "rattle", 0.01);
    std::string const torque = refusal(chain, [](auto const&, auto const& on) {
        on.torque[1] = {0, 0, 1};
        return std::nullopt;
    });
    EXPECT_NE(torque.find("a bead takes no torque (own force: body 2"), std::string::npos)
        << torque;
    std::string const infinite = refusal(chain, [](auto const&, auto const& on) {
        on.force[2][0] = INFINITY;
        return std::nullopt;
    });
    EXPECT_NE(infinite.find("own force on body 3"), std::string::npos) << infinite;
    Model gpu = chain;
    std::string const backend = refusal(gpu.set("solver.backend", "cuda"), nothing());
    EXPECT_NE(backend.find("own forces are computed on the host"), std::string::npos) << backend;
    Model domains = Model::from_text(
        "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: spherical}, "
        "beads: [{residue: ALA, position: [1, 0, 0]}]}]}]\n"
        "forces: {openmm: {builder: calvados2}}\n"
        "dynamics: {integrator: rk4, step: 0.001}\n");
    std::string const bodies = refusal(domains, nothing());
    EXPECT_NE(bodies.find("exclude each other"), std::string::npos) << bodies;
}

TEST(OwnForce, PassesItsOwnExceptions) {
    OwnForce const fails = [](auto const&, auto const&) -> std::optional<double> {
        throw std::out_of_range("mine");
    };
    EXPECT_THROW(Simulation(model_of(beads(4), "rattle", 0.01), fails), std::out_of_range);
}

}  // namespace
}  // namespace catena::test
