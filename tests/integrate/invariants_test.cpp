// Momentum, angular momentum, energy and closed joints under the integrators, and their order.
#include <gtest/gtest.h>

#include <stdexcept>

#include "integrate/joint_integrators.hpp"
#include "reader/load_scene.hpp"
#include "tests/integrate/constrained_run.hpp"
#include "tests/support/integrators.hpp"

namespace catena::test {
namespace {

std::string const bodies =
    "chains: [{name: a, base: free, generator: {random: {bodies: 12, joint: spherical, seed: "
    "1}}}]\n";
std::string const beads =
    "chains: [{name: a, generator: {freely_jointed: {beads: 30, length: 0.38}}}]\n";
std::string const hanging =
    "chains: [{name: a, base: fixed, generator: {random: {bodies: 8, joint: spherical, seed: "
    "4}}}]\nforces: {gravity: [0, 0, -5]}\n";

std::string const linked =
    "chains: [{name: a, base: free, generator: {random: {bodies: 14, joint: link, rigid: 0.5, "
    "seed: 2}}}]\n";
std::string const held =
    "chains: [{name: a, base: fixed, tip: {joint: {type: spherical}}, generator: {random: {bodies: "
    "8, joint: spherical, seed: 4}}},"
    " {name: b, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, generator: {random: "
    "{bodies: 9, joint: link, rigid: 0.5, seed: "
    "4}}}]\n"
    "forces: {gravity: [0, 0, -5]}\n";

// Impulses act equal and opposite at one point, up to the joints' closing: eps a step from rounding
// and the constraint error from the point's two places.
TEST(Rattle, FreeChainsKeepTheirMomenta) {
    for (std::string const& text : {bodies, beads, linked}) {
        Constrained run(text, 0.004);
        Momenta const before = momenta(run.scene(), run.snapshot());
        run.run(2000);
        Momenta const after = momenta(run.scene(), run.snapshot());
        double const bound = 2000 * 64 * 0x1p-53 * before.size + 2000 * 1e-14 * before.size;
        EXPECT_LE(norm(after.linear - before.linear), bound);
        EXPECT_LE(norm(after.angular - before.angular), bound);
        EXPECT_LE(run.constraint_error(), 1e-11);
    }
}

TEST(Rattle, EnergyErrorFallsByFourWhenTheStepIsHalved) {
    for (std::string const& text : {bodies, beads, hanging, linked, held}) {
        double rms[2];
        for (int half = 0; half < 2; ++half) {
            double const step = half ? 0.002 : 0.004;
            Constrained run(text, step);
            std::vector<double> energies;
            for (int i = 0; i < 200; ++i) {
                run.run(half ? 2 : 1);
                energies.push_back(run.energy());
            }
            double mean = 0, square = 0;
            for (double const e : energies) mean += e / static_cast<double>(energies.size());
            for (double const e : energies)
                square += (e - mean) * (e - mean) / static_cast<double>(energies.size());
            rms[half] = std::sqrt(square);
        }
        EXPECT_NEAR(rms[0] / rms[1], 4.0, 0.5) << text;
    }
}

TEST(Langevin, HeatsAColdChainToItsTemperature) {
    for (std::string const& text : {bodies, beads, linked}) {
        Constrained run(text, 0.004, Integrator::g_baoab, 5.0, 0.00831446261815324 * 150);
        run.run(500);
        double mean = 0;
        int const samples = 400;
        for (int i = 0; i < samples; ++i) {
            run.run(10);
            mean +=
                2 * kinetic_energy(run.scene(), run.snapshot()) /
                (run.scene().boltzmann() * static_cast<double>(degrees_of_freedom(run.scene()))) /
                samples;
        }
        // 400 samples every 0.04 ps at friction 5/ps (energy forgets at twice that): about 100
        // independent ones of 39 squares and more.
        double const error =
            150 * std::sqrt(2.0 / static_cast<double>(degrees_of_freedom(run.scene())) / 100);
        EXPECT_NEAR(mean, 150, 4 * error) << text;
        EXPECT_LE(run.constraint_error(), 1e-10);
    }
}

TEST(Programs, HaveTheSweepsOfTheirOperators) {
    auto const sweeps = [](Integrator integrator, bool warm) {
        SweepsAStep const s = program_of(integrator, warm).sweeps();
        return std::pair(s.matrices, s.biases);
    };
    EXPECT_EQ(sweeps(Integrator::rk4, false), std::pair(4, 4));
    EXPECT_EQ(sweeps(Integrator::velocity_verlet, false), std::pair(1, 1));
    EXPECT_EQ(sweeps(Integrator::leapfrog, false), std::pair(1, 2));
    for (bool const warm : {false, true})  // the default friction is not 0
        EXPECT_EQ(sweeps(Integrator::staggered, warm), std::pair(1, 2));
    EXPECT_EQ(sweeps(Integrator::baoab, true), std::pair(2, 3));
    EXPECT_EQ(sweeps(Integrator::implicit_baoab, false), std::pair(1, 2));
    for (IntegratorTraits const& row : integrators)
        if (row.joint_coordinates && !row.adaptive)
            EXPECT_FALSE(program_of(row.kind, row.langevin).step.empty()) << row.name;
        else
            EXPECT_THROW(program_of(row.kind, false), std::logic_error) << row.name;
}

/// log2 of the ratio of errors at two step sizes against a reference with many steps.
double order_of(Scene const& scene, Integrator kind) {
    auto const communicator = serial_communicator();
    double constexpr time = 0.2;
    auto const end_of = [&](int steps, bool reference) {
        ChainSystem system(scene, Axes::joint, *communicator);
        JointDynamics& dynamics = *system.joint().front();
        auto const integrator = make_joint(system, reference ? Integrator::rk4 : kind);
        system.close_tips();
        for (int i = 0; i < steps; ++i) {
            dynamics.set_time(i * time / steps);
            integrator->step(time / steps);
            system.close_tips();
        }
        EXPECT_LE(dynamics.closure_error(), 1e-12);
        return system.snapshot().position;
    };
    auto const exact = end_of(1280, true);
    auto const error_of = [&](int steps) {
        auto const x = end_of(steps, false);
        double worst = 0;
        for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, norm(x[i] - exact[i]));
        return worst;
    };
    int const coarse = traits_of(kind).order == 4 ? 20 : 40;
    return std::log2(error_of(coarse) / error_of(2 * coarse));
}

TEST(JointIntegrators, HaveTheirOrderForEveryJoint) {
    for (char const* joint : {"revolute", "spherical", "universal", "prismatic", "helical", "mixed",
                              "cylindrical", "planar3"})
        for (char const* base : {"free", "fixed"}) {
            Scene const scene =
                parse_scene(std::string("chains: [{name: a, base: ") + base +
                                ", generator: {random: {bodies: 5, joint: " + joint +
                                ", seed: 6}}}]\nforces: {gravity: [0, 1, -2], drag: {linear: 0.3, "
                                "angular: 0.1}}\n",
                            "scene.yaml");
            EXPECT_NEAR(order_of(scene, Integrator::rk4), 4.0, 0.4) << joint << " " << base;
            for (Integrator const second : {Integrator::velocity_verlet, Integrator::leapfrog})
                EXPECT_NEAR(order_of(scene, second), 2.0, 0.3)
                    << joint << " " << base << " " << name_of(second);
        }
}

}  // namespace
}  // namespace catena::test
