// What generators make is physical, repeatable and the same for every length.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "generate/generators.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "scene/pose.hpp"
#include "scene/scene.hpp"

namespace catena::test {
namespace {

ChainSpec random_chain(int n, std::string const& joint, std::string const& base, int seed) {
    return parse_scene("chains: [{base: " + base +
                           ", generator: {random: {bodies: " + std::to_string(n) +
                           ", joint: " + joint + ", seed: " + std::to_string(seed) + "}}}]",
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
        EXPECT_NEAR(std::hypot(std::hypot(b.q[k][0], b.q[k][1]), std::hypot(b.q[k][2], b.q[k][3])),
                    1, 1e-15);
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
    auto const loaded = std::count_if(b.wrench.begin(), b.wrench.end(),
                                      [](auto const& w) { return norm(w.second) > 0; });
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
                Vec3 const link = b.position[k] - b.position[k - 1],
                           rate = b.velocity[k] - b.velocity[k - 1];
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
    BodyArrays const few = random_chain(5, "revolute", "fixed", 9).bodies,
                     many = random_chain(500, "revolute", "fixed", 9).bodies;
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
        "chains: [{count: 2, base: fixed, generator: {random: {bodies: 3, joint: spherical, seed: "
        "18446744073709551615}}}]",
        "s.yaml");
    EXPECT_NE(s.chains[0].bodies.mass[0], s.chains[1].bodies.mass[0]);
    EXPECT_EQ(parse_scene("chains: [{base: fixed, generator: {random: {bodies: 3, joint: "
                          "spherical, seed: 18446744073709551615}}}]",
                          "s.yaml")
                  .chains[0]
                  .bodies.mass[0],
              s.chains[0].bodies.mass[0]);
}

TEST(Generators, pendulum_of_the_chapter) {
    ChainSpec const chain =
        parse_scene(
            "chains: [{generator: {pendulum: {links: 4, mass: 12, length: 2, radius: 0.1}}}]",
            "s.yaml")
            .chains[0];
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
    BeadArrays const b = parse_scene(
                             "chains: [{generator: {freely_jointed: {beads: 20001, length: 0.5, "
                             "mass: 3, seed: 4}}}]",
                             "s.yaml")
                             .chains[0]
                             .beads;
    double cosines = 0;
    for (std::size_t k = 1; k < b.size(); ++k)
        EXPECT_NEAR(norm(b.position[k] - b.position[k - 1]), 0.5, 1e-12);
    for (std::size_t k = 2; k < b.size(); ++k)
        cosines +=
            4 * dot(b.position[k] - b.position[k - 1], b.position[k - 1] - b.position[k - 2]);
    EXPECT_NEAR(cosines / 19999, 0, 4 * std::sqrt(1.0 / 3 / 19999));  // independent directions
    EXPECT_EQ(b.mass[7], 3);
    EXPECT_EQ(b.residue[0], "UNK");
}

TEST(Generators, every_random_joint) {
    using enum JointType;
    for (auto const& [name, type] :
         std::vector<std::pair<std::string, JointType>>{{"planar", revolute},
                                                        {"universal", universal},
                                                        {"weld", weld},
                                                        {"prismatic", prismatic},
                                                        {"helical", helical},
                                                        {"cylindrical", cylindrical},
                                                        {"planar3", planar3}}) {
        ChainSpec const chain = random_chain(50, name, "fixed", 3);
        BodyArrays const& b = chain.bodies;
        for (std::size_t k = 0; k < b.size(); ++k) {
            EXPECT_EQ(b.joint[k], type);
            EXPECT_TRUE(type != universal || norm(cross(b.first_axis[k], b.axis[k])) >= 0.5);
            EXPECT_TRUE(type != planar3 || std::abs(dot(b.first_axis[k], b.axis[k])) <= 4e-16);
            EXPECT_TRUE(type != helical || std::abs(b.pitch[k]) >= 0.05);
            EXPECT_TRUE(type != weld || norm(b.torque[k]) == 0);
            EXPECT_NEAR(norm(b.axis[k]), type == weld ? 0 : 1, 1e-15);
        }
        EXPECT_EQ(scene::handle_kind(chain) == scene::HandleKind::planar, name == "planar");
    }
}

TEST(Generators, mixed_joints_come_in_equal_numbers) {
    BodyArrays const b = random_chain(6000, "mixed", "free", 3).bodies;
    for (JointType const type : {JointType::revolute, JointType::universal, JointType::spherical,
                                 JointType::prismatic, JointType::helical, JointType::weld})
        EXPECT_NEAR(static_cast<double>(std::count(b.joint.begin(), b.joint.end(), type)), 1000,
                    4 * std::sqrt(6000 * 5.0 / 36));
    BodyArrays const few = random_chain(7, "mixed", "free", 3).bodies;
    for (std::size_t k = 0; k < 7; ++k)
        EXPECT_TRUE(few.joint[k] == b.joint[k] && few.q[k] == b.q[k] && few.pitch[k] == b.pitch[k]);
}

BodyArrays rods(std::string const& generator) {
    return parse_scene("chains: [{generator: {" + generator + "}}]", "s.yaml").chains.at(0).bodies;
}

TEST(Generators, distributions) {
    BodyArrays const b = rods(
        "pendulum: {links: 10000, mass: {log_uniform: [1e-6, 1e6]}, length: {normal: [1, 0.5]}, "
        "radius: {choice: [0.1, 0.2]}, seed: 4}");
    double mean = 0, length = 0;
    int thin = 0;
    for (std::size_t k = 0; k < b.size(); ++k) {
        mean += std::log10(b.mass[k]) / 10000;
        EXPECT_TRUE(b.mass[k] >= 1e-6 && b.mass[k] <= 1e6);
        EXPECT_GT(b.com[k][0], 0);
        length += 2 * b.com[k][0] / 10000;
        double const radius = std::sqrt(2 * b.inertia[k](0, 0) / b.mass[k]);
        EXPECT_TRUE(std::abs(radius - 0.1) < 1e-12 || std::abs(radius - 0.2) < 1e-12);
        thin += radius < 0.15;
    }
    EXPECT_NEAR(mean, 0, 4 * 12 / std::sqrt(12.0 * 10000));
    EXPECT_NEAR(thin, 5000, 4 * 50);
    // Normal numbers cut at 0: mean 1 + sd phi(2) / Phi(2).
    EXPECT_NEAR(length, 1 + 0.5 * 0.0539910 / 0.9772499, 4 * 0.5 / 100);
    BodyArrays const few = rods(
        "pendulum: {links: 3, mass: {log_uniform: [1e-6, 1e6]}, length: {normal: [1, 0.5]}, "
        "radius: {choice: [0.1, 0.2]}, seed: 4}");
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_TRUE(few.mass[k] == b.mass[k] && few.com[k][0] == b.com[k][0]);
    for (double const mass : rods("pendulum: {links: 100, mass: {uniform: [2, 3]}}").mass)
        EXPECT_TRUE(mass >= 2 && mass <= 3);
}

TEST(Generators, random_masses_and_inertias_by_distribution) {
    BodyArrays const b = rods(
        "random: {bodies: 2000, joint: spherical, mass: 3, inertia: {log_uniform: [1e-8, 1]}, "
        "length: 2}");
    double largest = 0;
    for (std::size_t k = 0; k < b.size(); ++k) {
        EXPECT_EQ(b.mass[k], 3);
        Eigen::Vector3d const moments = principal_moments(b.inertia[k]);
        largest = std::max(largest, moments[2] / moments[0]);
    }
    EXPECT_GT(largest, 1e4);
    EXPECT_NEAR(norm(b.translation[1]), 2, 1e-14);
}

TEST(Generators, random_pendulums_differ_and_equal_ones_do_not) {
    auto const chains = [](std::string const& mass) {
        return parse_scene(
                   "chains: [{count: 2, generator: {pendulum: {links: 3, mass: " + mass + "}}}]",
                   "s.yaml")
            .chains;
    };
    EXPECT_EQ(chains("2")[0].bodies.mass, chains("2")[1].bodies.mass);
    EXPECT_NE(chains("{uniform: [1, 2]}")[0].bodies.mass,
              chains("{uniform: [1, 2]}")[1].bodies.mass);
}

TEST(Generators, a_coil_winds_up) {
    ChainSpec const chain =
        parse_scene("chains: [{generator: {coil: {bodies: 200}}}]", "s.yaml").chains[0];
    BodyArrays const& b = chain.bodies;
    EXPECT_EQ(chain.base, Base::fixed);
    scene::Pose pose;
    double reach = 0;
    for (std::size_t k = 0; k < b.size(); ++k) {
        EXPECT_EQ(b.mass[k], 1);
        EXPECT_EQ(b.q[k][0], 0.3);
        pose = scene::next_pose(b, k, pose);
        reach = std::max(reach, norm(pose.origin));
    }
    EXPECT_LT(reach, 70);  // a helix, not a rod of length 199
    EXPECT_EQ(scene::handle_kind(chain), scene::HandleKind::revolute);
}

TEST(Generators, a_dill_is_self_similar) {
    BodyArrays const b = rods("dill: {bodies: 64, mass: 8, length: 2, radius: 0.2}");
    auto const size = [&](std::size_t number) { return 2 * b.com[number - 1][0]; };
    EXPECT_EQ(size(1), 2);
    EXPECT_EQ(size(2), 1);
    EXPECT_EQ(size(12), 0.5);
    EXPECT_EQ(size(64), 2.0 / 64);
    EXPECT_EQ(b.mass[63], 8.0 / (64.0 * 64 * 64));
    EXPECT_EQ(b.translation[2][0], 1);  // rod 2's length
    EXPECT_EQ(parse_scene("chains: [{base: free, generator: {dill: {bodies: 3}}}]", "s.yaml")
                  .chains[0]
                  .bodies.joint[0],
              JointType::free);
}

TEST(WormLike, bending_solves_langevins_equation) {
    for (double const ratio : {1e-12, 1e-6, 1e-3, 0.1, 0.2, 1.0, 3.0, 6.5, 7.0, 30.0}) {
        double const kappa = scene::bending_of(ratio), c = std::exp(-ratio),
                     rest = -std::expm1(-ratio);
        if (kappa > 0.1) {
            double const found = 1 / kappa - 2 / std::expm1(2 * kappa);
            EXPECT_NEAR(found, rest, 1e-12 * rest) << ratio;
        } else {
            EXPECT_NEAR(kappa / 3 - kappa * kappa * kappa / 45, c, 1e-9 * c) << ratio;
        }
    }
}

TEST(WormLike, directions_forget_each_other_as_they_should) {
    int constexpr n = 40001;
    double constexpr length = 0.34, persistence = 5 * 0.34;
    BeadArrays const b = parse_scene(
                             "chains: [{generator: {worm_like: {bodies: 40001, persistence: 1.7, "
                             "length: 0.34, mass: 650, seed: 5}}}]",
                             "s.yaml")
                             .chains[0]
                             .beads;
    ASSERT_EQ(b.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(b.mass[3], 650);
    EXPECT_EQ(b.length[0], 0);
    std::vector<Vec3> direction;
    for (std::size_t k = 1; k < b.size(); ++k) {
        direction.push_back((1 / length) * (b.position[k] - b.position[k - 1]));
        ASSERT_NEAR(norm(direction.back()), 1, 1e-11);
    }
    for (std::size_t apart : {1, 2, 4, 8}) {
        double mean = 0;
        std::size_t const pairs = direction.size() - apart;
        for (std::size_t k = 0; k < pairs; ++k)
            mean += dot(direction[k], direction[k + apart]) / static_cast<double>(pairs);
        // Neighbouring pairs are correlated over about P / l = 5 links.
        EXPECT_NEAR(mean, std::exp(-static_cast<double>(apart) * length / persistence),
                    4 * 0.6 * std::sqrt(10.0 / n))
            << apart;
    }
}

TEST(WormLike, end_to_end_distance_is_the_exact_one) {
    int constexpr copies = 4000, links = 30;
    Scene const scene = parse_scene(
        "chains: [{count: 4000, generator: {worm_like: {bodies: 31, persistence: 5, length: 1, "
        "seed: 8}}}]",
        "s.yaml");
    double square = 0, fourth = 0;
    for (ChainSpec const& chain : scene.chains) {
        Vec3 const end = chain.beads.position[links] - chain.beads.position[0];
        square += dot(end, end) / copies;
        fourth += dot(end, end) * dot(end, end) / copies;
    }
    double const c = std::exp(-0.2), exact = links * (1 + c) / (1 - c) -
                                             2 * c * (1 - std::pow(c, links)) / ((1 - c) * (1 - c));
    EXPECT_NEAR(square, exact, 4 * std::sqrt((fourth - square * square) / copies));
}

TEST(WormLike, bead_k_does_not_depend_on_n) {
    auto const beads = [](int n) {
        return parse_scene(
                   "chains: [{base: fixed, generator: {worm_like: {bodies: " + std::to_string(n) +
                       ", persistence: 3, length: {uniform: [0.5, 1]}, seed: 8}}}]",
                   "s.yaml")
            .chains[0]
            .beads;
    };
    BeadArrays const few = beads(4), many = beads(40);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(few.length[k], many.length[k]);
        EXPECT_EQ(few.position[k][0], many.position[k][0]);
        EXPECT_NEAR(norm(few.position[k] - (k == 0 ? few.anchor : few.position[k - 1])),
                    few.length[k], 1e-14);
    }
}

}  // namespace
}  // namespace catena::test
