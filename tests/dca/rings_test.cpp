// Chains closed on themselves, and loops that hold a chain more than once: every backend and handle
// kind against the oracles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/reference_data.hpp"
#include "tests/support/variants.hpp"

namespace catena::test {
namespace {

double constexpr eps = 0x1p-53;

Variant const variants[] = {
    {Backend::serial, Handles::projected},      {Backend::serial, Handles::full},
    {Backend::segments, Handles::projected},    {Backend::segments, Handles::full},
    {Backend::cuda, Handles::projected},        {Backend::cuda, Handles::full},
    {Backend::cuda_levels, Handles::projected}, {Backend::cuda_levels, Handles::full}};

class Rings : public WithVariant {};
INSTANTIATE_TEST_SUITE_P(Variants, Rings, testing::ValuesIn(variants), name_of_variant);

/// A regular polygon of bars of length 1, the first of which moves; `closing` is the joint of the
/// last to the first.
std::string polygon(int bars, std::string const& type, std::string const& closing) {
    double const half = std::acos(-1.0) / bars;
    std::string const body =
        "{mass: 1, com: [0.5, 0.01, 0.02], inertia: [0.02, 0.084, 0.09], joint: ";
    std::string text = "units: si\nchains:\n  - base: free\n    bodies:\n      - " + body +
                       "{type: free, qd: {omega: [0.3, -0.2, 0.5], velocity: [1, 2, 3]}}}\n";
    for (int k = 1; k < bars; ++k)
        text += fmt::format("      - {}{{type: {}, translation: [1, 0, 0], q: {}}}}}\n", body, type,
                            type == "spherical"
                                ? fmt::format("[{:.17g}, 0, 0, {:.17g}], qd: [{}, 0.5, -1]",
                                              std::cos(half), std::sin(half), k)
                                : fmt::format("{:.17g}, axis: [0, 0, 1], qd: {}", 2 * half, k));
    return text + "    tip: {ring: {type: " + closing +
           ", translation: [1, 0, 0]}}\nforces: {gravity: [1, 2, -9.81]}\n";
}

/// As the solver's velocities are after they were made to fit.
ChainSpec fitted(Scene const& scene) {
    ChainSpec chain = scene.chains[0];
    oracle::project_velocities(chain);
    return chain;
}

struct Errors {
    double acceleration = 0, force = 0, residual = 0, residual_bound = 0;
};
Errors errors(Scene const& scene, oracle::OracleResult<long double> const& expected,
              Communicator const& communicator) {
    ChainSystem system(scene, Axes::joint, communicator);
    system.evaluate();
    ChainSystem::Accelerations const found = system.accelerations();
    std::vector<Vec3> force, torque;
    for (auto const& f : found.joint_force)
        torque.push_back({{f[0], f[1], f[2]}}), force.push_back({{f[3], f[4], f[5]}});
    std::vector<Vector<long double, 3>> expected_force, expected_torque;
    for (auto const& f : expected.constraint_force)
        expected_torque.push_back(f.torque), expected_force.push_back(f.force);
    auto const error = [](std::vector<Vec3> const& values,
                          std::vector<Vector<long double, 3>> const& exact) {
        return static_cast<double>(relative_difference(converted<long double>(values), exact));
    };
    return {std::max(error(found.acceleration, expected.com_acceleration),
                     error(found.alpha, expected.alpha)),
            std::max(error(force, expected_force), error(torque, expected_torque)),
            system.residual(), system.residual_bound()};
}

/// The ring: all constraints at once by Lagrange's multipliers, in another scalar and by
/// another solver.
TEST_P(Rings, twelve_bodies_on_spherical_joints_agree_with_one_dense_system) {
    Scene scene = with_backend(parse_scene(polygon(12, "spherical", "spherical"), "ring.yaml"));
    scene.chains[0] = fitted(scene);
    auto const exact = oracle::dense<long double>(scene.chains[0], {scene.forces.gravity, {}});
    Errors const e = errors(scene, exact, *communicator_);
    RecordProperty("acceleration_error", fmt::format("{:.1e}", e.acceleration));
    EXPECT_LE(e.acceleration, 1e-10);
    EXPECT_LE(e.force, 1e-10);
    EXPECT_LE(e.residual, e.residual_bound);
    ChainSpec const& chain = scene.chains[0];
    EXPECT_EQ(chain.bodies.size(), 12U);
    EXPECT_GT(norm(exact.constraint_force[0].force), 1);  // the closing joint carries something
}

/// Across its plane a planar ring is held three times over; two bars between two balls turn about
/// the line through them.
TEST_P(Rings, redundant_rings_move_as_the_oracle_says) {
    for (auto const& [text, bars] :
         {std::pair{polygon(4, "revolute", "revolute, axis: [0, 0, 1]"), 4},
          std::pair{polygon(5, "revolute", "revolute, axis: [0, 0, 1]"), 5},
          std::pair{polygon(5, "revolute", "spherical"), 5},
          std::pair{polygon(2, "spherical", "spherical"), 2}}) {
        SCOPED_TRACE(text);
        Scene scene = with_backend(parse_scene(text, "ring.yaml"));
        scene.chains[0] = fitted(scene);
        auto const exact = oracle::aba<long double>(scene.chains[0], {scene.forces.gravity, {}});
        Errors const e = errors(scene, exact, *communicator_);
        EXPECT_LE(e.acceleration, 1e-11) << bars;
        EXPECT_LE(e.residual, e.residual_bound);
    }
}

/// The same of bridges: a planar linkage with all of its handles, Bricard's, a rod between two
/// balls.
TEST_P(Rings, redundant_bridges_move_as_the_oracle_says) {
    std::string const inputs = CATENA_SOURCE_DIR "/inputs/";
    Scene const rod = parse_scene(
        "units: si\nchains: [{base: fixed, bodies: [{mass: 1, com: [0.5, 0.1, 0], inertia: [0.1, "
        "0.1, 0.1], joint: {type: spherical, qd: "
        "[2, 0, 0]}}], tip: {joint: {type: spherical, translation: [1, 0, 0]}}}]\nforces: "
        "{gravity: [0, 0, -9.81]}\n",
        "rod.yaml");
    for (Scene const& given :
         {load_scene(inputs + "four-bar.yaml"), load_scene(inputs + "bricard.yaml"), rod}) {
        SCOPED_TRACE(given.title);
        Scene scene = with_backend(given);
        scene.forces.gravity = {{3, -9.81, 1}};
        auto const exact = oracle::aba<long double>(scene.chains[0], {scene.forces.gravity, {}});
        Errors const e = errors(scene, exact, *communicator_);
        EXPECT_LE(e.acceleration, 1e-11);
        EXPECT_LE(e.residual, e.residual_bound);
    }
}

/// A chain that moves across `n`: joint 1 of type `first`, then joints of type `next`, and `tip`.
std::string flat_loop(int bodies, std::string const& first, std::string const& next,
                      std::string const& tip) {
    std::string const free = first == "free" ? "free" : "fixed",
                      n = free == "free" ? "[0, 0, 1]" : "[0.36, 0.48, 0.8]",
                      across = free == "free" ? "[1, 0, 0]" : "[0.8, -0.6, 0]";
    auto const joint = [&](std::string const& type, int k) {
        if (type == "free") return std::string("{type: free, qd: {omega: [0, 0, 0.5]}}");
        std::string const at = ", translation: [1, 0.1, 0]";
        if (type == "planar3")
            return fmt::format(
                "{{type: planar3, axes: [{}, {}]{}, q: [0.1, {}, 0.4], qd: [{}, 1, "
                "-0.5], torque: [1, 2, 0.5]}}",
                across, n, at, 0.1 * (k % 4), k % 3);
        return fmt::format("{{type: revolute, axis: {}{}, q: {}, qd: {}}}", n, at,
                           0.3 + 0.2 * (k % 4), 0.5 * (k % 3) - 0.4);
    };
    std::string text = "units: si\nchains:\n  - base: " + free + "\n    bodies:\n";
    for (int k = 0; k < bodies; ++k)
        text += "      - {mass: 2, com: [0.5, 0.1, 0.3], inertia: [0.5, 0.6, 0.7], joint: " +
                joint(k == 0 ? first : next, k) + "}\n";
    std::string const shape =
        tip == "planar3" ? fmt::format("axes: [{}, {}]", across, n) : "axis: " + n;
    return text +
           fmt::format("    tip: {{{}: {{type: {}, {}, translation: [1, 0, 0]}}}}\n",
                       free == "free" ? "ring" : "joint", tip, shape) +
           "forces: {gravity: [0, -9.81, 1]}\n";
}

/// All that the closing joint restricts is restricted already: its matrix is zero.
TEST_P(Rings, wholly_redundant_closing_joints_carry_nothing) {
    std::vector<std::string> texts;
    for (int const bodies : {2, 3, 4, 7, 12})
        for (char const* const tip : {"revolute", "planar3"})
            texts.push_back(flat_loop(bodies, "planar3", "revolute", tip));
    for (int const bodies : {2, 5, 40})
        for (char const* const next : {"revolute", "planar3"})
            texts.push_back(flat_loop(bodies, "free", next, "planar3"));
    for (std::string const& text : texts) {
        SCOPED_TRACE(text);
        Scene scene = with_backend(parse_scene(text, "flat.yaml"));
        scene.chains[0] = fitted(scene);
        auto const exact = oracle::aba<long double>(scene.chains[0], {scene.forces.gravity, {}});
        Errors const e = errors(scene, exact, *communicator_);
        EXPECT_LE(e.acceleration, 1e-11);
        EXPECT_LE(e.residual, e.residual_bound);
    }
}

/// Of every kind of joints and closing joint, against articulated bodies.
TEST_P(Rings, random_rings_agree_with_articulated_bodies) {
    JointType const closing[] = {JointType::spherical, JointType::revolute,    JointType::universal,
                                 JointType::weld,      JointType::prismatic,   JointType::helical,
                                 JointType::spherical, JointType::cylindrical, JointType::planar3};
    RandomJoints const joints[] = {RandomJoints::revolute, RandomJoints::spherical,
                                   RandomJoints::mixed,    RandomJoints::universal,
                                   RandomJoints::helical,  RandomJoints::any};
    RandomJoints const later[] = {RandomJoints::cylindrical, RandomJoints::planar3,
                                  RandomJoints::all};
    for (std::uint64_t seed = 0; seed < 108; ++seed) {
        bool const first = seed < 72;
        RandomChainOptions const options{.bodies = 12 + seed * 5 % 40,
                                         .joints = first ? joints[seed % 6] : later[seed % 3],
                                         .base = Base::free,
                                         .springs = seed % 3 == 0,
                                         .tip = closing[seed / 6 % (first ? 6 : 9)],
                                         .ring = true};
        Scene scene;
        scene.chains = {random_chain(seed, options)};
        scene.forces.gravity = {{0.3, -0.2, -9.81}};
        oracle::Loads const loads{scene.forces.gravity, {}};
        auto const exact = oracle::aba<long double>(scene.chains[0], loads);
        Errors const e = errors(with_backend(scene), exact, *communicator_);
        double const condition = oracle::condition_estimate(scene.chains[0], loads);
        double const bound = 64 * eps * static_cast<double>(options.bodies) * condition;
        SCOPED_TRACE(seed);
        EXPECT_LE(e.acceleration, bound);
        EXPECT_LE(e.force, 8 * bound);
        EXPECT_LE(e.residual, e.residual_bound);
    }
}

}  // namespace
}  // namespace catena::test
