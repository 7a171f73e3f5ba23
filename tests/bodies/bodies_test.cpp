// Rigid bodies as the arrays hold them.
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "reader/load_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

double constexpr eps = std::numeric_limits<double>::epsilon();

BodyArrays bodies_of(std::string const& list, std::string const& base = "fixed") {
    return parse_scene("chains: [{base: " + base + ", bodies: [" + list + "]}]", "s.yaml")
        .chains.at(0)
        .bodies;
}

TEST(Bodies, everything_that_a_body_can_say) {
    BodyArrays const b = bodies_of(
        "{mass: 1.2, com: [0, 0, -0.2], inertia: [[1, 0.1, 0.2], [0.1, 2, 0.3], [0.2, 0.3, 2.5]],"
        " joint: {type: revolute, axis: [0, 0, 2], rotation: [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "
        "translation: [0, 0, -0.4],"
        "         q: 0.3, qd: 0.1, torque: 0.5, stiffness: 7, damping: 0.25, rest: 0.125}, wrench: "
        "{torque: [1, 2, 3], force: [4, 5, 6]}},"
        "{mass: 2, inertia: [1, 1, 1], joint: {type: spherical, q: [0.6, 0, 0.8, 0], qd: [1, 2, "
        "3], torque: [4, 5, 6], stiffness: [1, 2, "
        "3], damping: 2, rest: [0, 1, 0, 0]}}");
    ASSERT_EQ(b.size(), 2u);
    EXPECT_EQ(b.mass[0], 1.2);
    EXPECT_EQ(b.com[0][2], -0.2);
    EXPECT_EQ(b.inertia[0](2, 1), 0.3);
    EXPECT_EQ(b.inertia[0](1, 0), 0.1);
    EXPECT_EQ(b.joint[0], JointType::revolute);
    EXPECT_EQ(b.axis[0][2], 1);  // normalised
    EXPECT_EQ(b.rotation[0](0, 1), -1);
    EXPECT_EQ(b.translation[0][2], -0.4);
    EXPECT_EQ(b.q[0], (std::array<double, 4>{0.3, 0, 0, 0}));
    EXPECT_EQ(b.qd[0][0], 0.1);
    EXPECT_EQ(b.torque[0][0], 0.5);
    EXPECT_EQ(b.stiffness[0][0], 7);
    EXPECT_EQ(b.damping[0][0], 0.25);
    EXPECT_EQ(b.rest[0], (std::array<double, 4>{0.125, 0, 0, 0}));
    EXPECT_EQ(b.wrench[0].first[1], 2);
    EXPECT_EQ(b.wrench[0].second[2], 6);
    EXPECT_EQ(b.joint[1], JointType::spherical);
    EXPECT_NEAR(b.q[1][2], 0.8, eps);
    EXPECT_EQ(b.qd[1][2], 3);
    EXPECT_EQ(b.torque[1][1], 5);
    EXPECT_EQ(b.stiffness[1][2], 3);
    EXPECT_EQ(b.damping[1][2], 2);
    EXPECT_EQ(b.rest[1], (std::array<double, 4>{0, 1, 0, 0}));
    EXPECT_EQ(b.wrench[1].second[2], 0);
}

TEST(Bodies, defaults) {
    BodyArrays const b = bodies_of(
        "{mass: 1, inertia: [1, 1, 1], joint: {type: spherical}}, {mass: 1, inertia: [1, 1, 1], "
        "joint: {type: revolute, axis: [1, 0, 0]}}");
    EXPECT_EQ(b.q[0], (std::array<double, 4>{1, 0, 0, 0}));
    EXPECT_EQ(b.q[1], (std::array<double, 4>{0, 0, 0, 0}));
    EXPECT_EQ(b.rotation[1](1, 1), 1);
    EXPECT_EQ(b.com[0][0], 0);
    EXPECT_TRUE(b.torque.empty() && b.stiffness.empty() && b.damping.empty() && b.rest.empty() &&
                b.wrench.empty());
}

TEST(Bodies, free_base) {
    std::string const second =
        ", {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, stiffness: 3}}";
    BodyArrays b = bodies_of("{mass: 1, inertia: [1, 1, 1]}" + second, "free");
    EXPECT_EQ(b.joint[0], JointType::free);
    EXPECT_EQ(b.q[0][0], 1);
    EXPECT_EQ(b.rest[0][0], 1);
    EXPECT_EQ(b.stiffness[1][2], 3);
    b = bodies_of(
        "{mass: 1, inertia: [1, 1, 1], joint: {type: free, q: {position: [1, 2, 3], quaternion: "
        "[0, 0, 1, 0]}, qd: {omega: [4, 5, 6], "
        "velocity: [7, 8, 9]}}}" +
            second,
        "free");
    EXPECT_EQ(b.free_base.position[1], 2);
    EXPECT_EQ(b.free_base.velocity[2], 9);
    EXPECT_EQ(b.qd[0][0], 4);
    EXPECT_EQ(b.q[0][2], 1);
}

TEST(Bodies, given_state_and_velocities_key) {
    std::string const body =
        "bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [1, 0, 0], qd: 2}}]";
    ChainSpec const moving =
        parse_scene("chains: [{base: fixed, " + body + "}]", "s.yaml").chains[0];
    EXPECT_EQ(moving.velocities, StartVelocities::given);
    ChainSpec const halted =
        parse_scene("chains: [{base: fixed, velocities: zero, " + body + "}]", "s.yaml").chains[0];
    EXPECT_EQ(halted.velocities, StartVelocities::zero);
    EXPECT_EQ(halted.bodies.qd[0][0], 0);
}

TEST(Bodies, nearly_unit_values_become_unit_values) {
    BodyArrays const b = bodies_of(
        "{mass: 1, inertia: [1, 1, 1], joint: {type: spherical, q: [0.7071068, 0.7071068, 0, 0],"
        " rotation: [[0.8660254, -0.5, 0], [0.5, 0.8660254, 0], [0, 0, 1]]}}, {mass: 1, inertia: "
        "[1, 1, 1], joint: {type: revolute, axis: "
        "[1e-200, 1e-200, 0]}}");
    double norm2 = 0;
    for (double const x : b.q[0]) norm2 += x * x;
    EXPECT_NEAR(norm2, 1, 2 * eps);
    Mat3 const gram = transposed_times(b.rotation[0], b.rotation[0]);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(gram(i, j), i == j ? 1 : 0, 4 * eps);
    EXPECT_NEAR(b.axis[1][0], std::sqrt(0.5), eps);
}

TEST(Bodies, shapes_at_the_edge_of_what_is_possible) {
    auto const accepted = [](std::string const& inertia) {
        return refusal_of("chains: [{base: free, bodies: [{mass: 1, inertia: " + inertia +
                          "}]}]") == "accepted";
    };
    EXPECT_TRUE(accepted("[0.1, 0.2, 0.3]"));        // a flat plate: 0.1 + 0.2 is not 0.3 in binary
    EXPECT_TRUE(accepted("[1e-8, 1, 1]"));           // anisotropy of 1e8
    EXPECT_TRUE(accepted("[1e-30, 2e-30, 2e-30]"));  // small units
    EXPECT_TRUE(accepted("[[2, 0, 0], [0, 2, 1e-17], [0, 0, 2]]"));  // asymmetry below rounding
    EXPECT_FALSE(accepted("[0.1, 0.2, 0.30001]"));
    EXPECT_FALSE(accepted("[1e-16, 1, 1]"));
    EXPECT_FALSE(accepted("[[2, 0, 0], [0, 2, 1e-12], [0, 0, 2]]"));
}

TEST(Bodies, anchors_and_aliases) {
    BodyArrays const b = bodies_of(
        "{mass: 1, inertia: &i [[1, 0, 0], [0, 1, 0], [0, 0, 1]], joint: &j {type: revolute, axis: "
        "[0, 0, 1]}}, {mass: 2, inertia: *i, "
        "joint: *j}");
    EXPECT_EQ(b.size(), 2u);
    EXPECT_EQ(b.inertia[1](2, 2), 1);
}

/// JSON is YAML: the third-party chain goes through the parser and comes back bit for bit, but for
/// what is made orthonormal.
TEST(Bodies, third_party_chain_comes_back) {
    nlohmann::json reference;
    std::ifstream(CATENA_TEST_DATA "/reference/pinocchio-chain50.json") >> reference;
    nlohmann::json bodies = nlohmann::json::array();
    for (auto const& r : reference["bodies"]) {
        nlohmann::json joint = {
            {"type", r["joint"]["type"]}, {"q", r["q"]}, {"qd", r["qd"]}, {"torque", r["tau"]}};
        joint["rotation"] = r["joint"]["parent_pose"]["rotation"];
        joint["translation"] = r["joint"]["parent_pose"]["translation"];
        if (r["joint"]["type"] == "revolute") joint["axis"] = r["joint"]["axis"];
        bodies.push_back(
            {{"mass", r["mass"]}, {"com", r["com"]}, {"inertia", r["inertia"]}, {"joint", joint}});
    }
    nlohmann::json const scene = {{"chains", {{{"base", "fixed"}, {"bodies", bodies}}}}};
    BodyArrays const b = parse_scene(scene.dump(), "s.yaml").chains[0].bodies;
    ASSERT_EQ(b.size(), 50u);
    for (std::size_t k = 0; k < b.size(); ++k) {
        auto const& r = reference["bodies"][k];
        EXPECT_EQ(b.mass[k], r["mass"].get<double>());
        bool const revolute = r["joint"]["type"] == "revolute";
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(b.com[k][i], r["com"][i].get<double>());
            EXPECT_EQ(b.translation[k][i],
                      r["joint"]["parent_pose"]["translation"][i].get<double>());
            EXPECT_NEAR(b.axis[k][i], revolute ? r["joint"]["axis"][i].get<double>() : 0, eps);
            EXPECT_EQ(b.qd[k][i], !revolute ? r["qd"][i].get<double>()
                                  : i == 0  ? r["qd"].get<double>()
                                            : 0);
            for (int j = 0; j < 3; ++j) {
                EXPECT_EQ(b.inertia[k](i, j), r["inertia"][i][j].get<double>());
                EXPECT_NEAR(b.rotation[k](i, j),
                            r["joint"]["parent_pose"]["rotation"][i][j].get<double>(), 4 * eps);
            }
        }
        for (std::size_t i = 0; i < (revolute ? 1 : 4); ++i)
            EXPECT_NEAR(b.q[k][i], revolute ? r["q"].get<double>() : r["q"][i].get<double>(),
                        revolute ? 0 : 2 * eps);
    }
}

}  // namespace
}  // namespace catena::test
