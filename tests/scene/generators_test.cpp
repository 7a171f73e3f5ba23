// What generators make is physical, repeatable and the same for every length.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "scene/scene.hpp"

namespace catena::test {
namespace {

ChainSpec random_chain(int n, std::string const& joint, std::string const& base, int seed) {
    return parse_scene("chains: [{base: " + base + ", generator: {random: {bodies: " + std::to_string(n) + ", joint: " + joint +
                           ", seed: " + std::to_string(seed) + "}}}]",
                       "s.yaml")
        .chains.at(0);
}

Eigen::Vector3d principal_moments(Sym3 const& j) {
    Eigen::Matrix3d m;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) m(a, b) = j(a, b);
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues();
}

void expect_physical(BodyArrays const& b, std::size_t k) {
    Eigen::Vector3d const moments = principal_moments(b.inertia[k]);
    EXPECT_GT(b.mass[k], 0.49);
    EXPECT_LT(b.mass[k], 2.01);
    EXPECT_GE(moments[0], 0.0999 * b.mass[k]);
    EXPECT_GE(moments[0] + moments[1] - moments[2], 0.0999 * b.mass[k]);
    Mat3 const gram = transposed_times(b.rotation[k], b.rotation[k]);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(gram(i, j), i == j ? 1 : 0, 1e-15 * 4);
    if (b.joint[k] == JointType::revolute)
        EXPECT_NEAR(norm(b.axis[k]), 1, 1e-15);
    else
        EXPECT_NEAR(std::hypot(std::hypot(b.q[k][0], b.q[k][1]), std::hypot(b.q[k][2], b.q[k][3])), 1, 1e-15);
}

TEST(Generators, random_bodies_are_physical) {
    for (std::string const joint : {"revolute", "spherical"})
        for (std::string const base : {"fixed", "free"})
            for (int seed = 0; seed < 200; ++seed) {
                ChainSpec const chain = random_chain(16, joint, base, seed);
                BodyArrays const& b = chain.bodies;
                ASSERT_EQ(b.size(), 16u);
                EXPECT_EQ(b.joint[0] == JointType::free, base == "free");
                for (std::size_t k = 0; k < b.size(); ++k) expect_physical(b, k);
                for (std::size_t k = 1; k < b.size(); ++k) {
                    EXPECT_GE(norm(b.translation[k]), 0.4999);
                    EXPECT_LE(norm(b.translation[k]), 1.5001);
                }
                EXPECT_EQ(chain.velocities, StartVelocities::given);
            }
}

TEST(Generators, a_quarter_of_the_bodies_is_loaded) {
    BodyArrays const b = random_chain(10000, "spherical", "fixed", 5).bodies;
    auto const loaded = std::count_if(b.wrench.begin(), b.wrench.end(), [](auto const& w) { return norm(w.second) > 0; });
    EXPECT_NEAR(static_cast<double>(loaded), 2500, 4 * std::sqrt(10000 * 0.25 * 0.75));
    double mean = 0;
    for (Vec3 const& rate : b.qd) mean += rate[0] / 10000;
    EXPECT_NEAR(mean, 0, 4 * std::sqrt(1.0 / 3 / 10000));
}

TEST(Generators, random_links_satisfy_their_constraints) {
    for (std::string const base : {"fixed", "free"})
        for (int seed = 0; seed < 50; ++seed) {
            BeadArrays const b = random_chain(100, "link", base, seed).beads;
            for (std::size_t k = 1; k < b.size(); ++k) {
                Vec3 const link = b.position[k] - b.position[k - 1], rate = b.velocity[k] - b.velocity[k - 1];
                EXPECT_NEAR(norm(link), b.length[k], 1e-13);
                EXPECT_NEAR(dot(link, rate), 0, 1e-13);
                EXPECT_GE(b.length[k], 0.5);
                EXPECT_LE(b.length[k], 1.5);
            }
            if (base == "free")
                EXPECT_EQ(b.length[0], 0);
            else
                EXPECT_NEAR(norm(b.position[0]), b.length[0], 1e-15 * 4);
        }
}

TEST(Generators, body_k_does_not_depend_on_n) {
    BodyArrays const few = random_chain(5, "revolute", "fixed", 9).bodies, many = random_chain(500, "revolute", "fixed", 9).bodies;
    for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_EQ(few.mass[k], many.mass[k]);
        EXPECT_EQ(few.q[k], many.q[k]);
        for (int i = 0; i < 6; ++i) EXPECT_EQ(few.inertia[k].data[i], many.inertia[k].data[i]);
    }
    EXPECT_NE(few.mass[0], few.mass[1]);
    EXPECT_NE(few.mass[0], random_chain(5, "revolute", "fixed", 10).bodies.mass[0]);
}

TEST(Generators, copies_differ_and_seeds_are_whole_words) {
    Scene const s = parse_scene(
        "chains: [{count: 2, base: fixed, generator: {random: {bodies: 3, joint: spherical, seed: 18446744073709551615}}}]", "s.yaml");
    EXPECT_NE(s.chains[0].bodies.mass[0], s.chains[1].bodies.mass[0]);
    EXPECT_EQ(
        parse_scene("chains: [{base: fixed, generator: {random: {bodies: 3, joint: spherical, seed: 18446744073709551615}}}]", "s.yaml")
            .chains[0]
            .bodies.mass[0],
        s.chains[0].bodies.mass[0]);
}

TEST(Generators, pendulum_of_the_chapter) {
    ChainSpec const chain =
        parse_scene("chains: [{generator: {pendulum: {links: 4, mass: 12, length: 2, radius: 0.1}}}]", "s.yaml").chains[0];
    BodyArrays const& b = chain.bodies;
    EXPECT_EQ(chain.base, Base::fixed);
    ASSERT_EQ(b.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(b.joint[k], JointType::revolute);
        EXPECT_EQ(b.axis[k][2], 1);
        EXPECT_EQ(b.com[k][0], 1);
        EXPECT_EQ(b.translation[k][0], k == 0 ? 0 : 2);
        EXPECT_EQ(b.q[k][0], 0);
        EXPECT_EQ(b.qd[k][0], 0);
        EXPECT_DOUBLE_EQ(b.inertia[k](0, 0), 0.5 * 12 * 0.01);
        EXPECT_DOUBLE_EQ(b.inertia[k](2, 2), 12 * (3 * 0.01 + 4) / 12);
        EXPECT_EQ(b.inertia[k](1, 0), 0);
    }
}

TEST(Generators, freely_jointed_walk) {
    BeadArrays const b =
        parse_scene("chains: [{generator: {freely_jointed: {beads: 20001, length: 0.5, mass: 3, seed: 4}}}]", "s.yaml").chains[0].beads;
    double cosines = 0;
    for (std::size_t k = 1; k < b.size(); ++k) EXPECT_NEAR(norm(b.position[k] - b.position[k - 1]), 0.5, 1e-12);
    for (std::size_t k = 2; k < b.size(); ++k) cosines += 4 * dot(b.position[k] - b.position[k - 1], b.position[k - 1] - b.position[k - 2]);
    EXPECT_NEAR(cosines / 19999, 0, 4 * std::sqrt(1.0 / 3 / 19999));  // independent directions
    EXPECT_EQ(b.mass[7], 3);
    EXPECT_EQ(b.residue[0], "UNK");
}

}  // namespace
}  // namespace catena::test
