// The list of joint models: what every model states fits together, and what files rely on stays.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "generate/generators.hpp"
#include "generate/random.hpp"
#include "joints/joint_models.hpp"
#include "scene/freedom.hpp"

namespace catena::test {
namespace {

std::vector<JointType> types() {
    std::vector<JointType> all;
    for_each_joint([&](auto model) { all.push_back(decltype(model)::type); });
    return all;
}

/// Shape of a joint with random axes and a pitch; if the joint glides, its axes are perpendicular.
JointShape random_shape(scene::Draws& draws, bool glides = false) {
    Vec3 const axis = draws.on_sphere();
    Vec3 first = draws.on_sphere();
    while (norm(cross(first, axis)) < 0.5) first = draws.on_sphere();
    Vec3 const level = cross(first, axis);
    return {axis, glides ? (1 / norm(level)) * level : first, 0.2};
}

TEST(JointModels, names_and_codes_of_files_stay) {
    std::map<int, std::string> names;
    for_each_joint([&](auto model) { names[decltype(model)::code] = decltype(model)::name; });
    EXPECT_EQ(names, (std::map<int, std::string>{{0, "free"},
                                                 {1, "link"},
                                                 {2, "spherical"},
                                                 {3, "revolute"},
                                                 {4, "universal"},
                                                 {5, "weld"},
                                                 {6, "prismatic"},
                                                 {7, "helical"},
                                                 {8, "cylindrical"},
                                                 {9, "planar3"}}));
    for_each_joint(
        [](auto model) { EXPECT_STREQ(name_of(decltype(model)::type), decltype(model)::name); });
}

TEST(JointModels, every_type_is_listed_once) {
    std::set<JointType> distinct;
    for (JointType const type : types()) distinct.insert(type);
    EXPECT_EQ(distinct.size(), types().size());
    for (int code = 0; code < static_cast<int>(types().size()); ++code)
        EXPECT_TRUE(distinct.count(static_cast<JointType>(code)));
}

TEST(JointModels, free_and_restricted_directions_are_six) {
    for (JointType const type : types()) {
        EXPECT_EQ(freedom_of(type) + restricted_by(type), 6) << name_of(type);
        EXPECT_EQ(scene::coordinates_of(type), freedom_of(type));
        if (!floats(type) && !is_rod(type)) {
            EXPECT_EQ(numbers_of_joint(type), freedom_of(type)) << name_of(type);
        }
    }
}

TEST(JointModels, every_type_has_one_motion) {
    for (JointType const type : types()) {
        int motions = 0;
        joints::for_each(
            [&](auto motion) { motions += joints::has_motion<decltype(motion)>(type); },
            JointMotions{});
        EXPECT_EQ(motions, 1) << name_of(type);
        EXPECT_EQ(has_quaternion(type), joints::has_motion<QuaternionMotion>(type));
    }
}

TEST(JointModels, random_positions_keep_the_joint_closed) {
    scene::Draws draws(1, 0);
    for_each_joint([&](auto model) {
        using Model = decltype(model);
        for (int i = 0; i < 20; ++i) {
            JointShape const shape = random_shape(draws, Model::glides);
            auto const q = Model::random_position(draws);
            JointDisplacement const x = displacement_of(Model::type, shape, q);
            JointOpening const closed = Model::opening(shape, x.turn, x.shift);
            EXPECT_LT(closed.distance, 1e-14) << Model::name;
            EXPECT_LT(closed.angle, 1e-7) << Model::name;
            Vec3 const across = Model::glides ? shape.axis : cross(shape.axis, shape.first_axis);
            JointOpening const open = Model::opening(shape, x.turn, x.shift + 0.1 * across);
            EXPECT_GT(open.distance, 0.04) << Model::name;
        }
    });
}

TEST(JointModels, rest_position_is_the_identity) {
    scene::Draws draws(2, 0);
    JointShape const shape = random_shape(draws);
    for (JointType const type : types()) {
        if (is_rigid(type) || is_rod(type)) continue;
        JointDisplacement const x = displacement_of(type, shape, rest_position(type));
        EXPECT_EQ(norm(rotation_vector(x.turn)), 0) << name_of(type);
        EXPECT_EQ(norm(x.shift), 0) << name_of(type);
    }
}

TEST(JointModels, screws_are_normalised) {
    for_each_joint([](auto model) {
        Vec3 const s = decltype(model)::screw(0.3);
        EXPECT_NEAR(s[0] * s[0] + s[1] * s[1], 1, 1e-15);
        if (decltype(model)::order == usual_order) {
            EXPECT_EQ(s[1] != 0, slides(decltype(model)::type)) << decltype(model)::name;
        }
    });
}

/// An order is a permutation. Its first directions do no work along the joint's coordinates, and
/// the last three do.
TEST(JointModels, restricted_directions_come_first) {
    for_each_joint([](auto model) {
        using Model = decltype(model);
        std::set<int> directions;
        for (int i = 0; i < 6; ++i) directions.insert(direction_at(Model::order, i));
        EXPECT_EQ(directions, (std::set<int>{0, 1, 2, 3, 4, 5})) << Model::name;
        if (Model::order == usual_order) return;
        int turns = 0, shifts = 0;
        for (int i = Model::restricted; i < 6; ++i)
            (direction_at(Model::order, i) < 3 ? shifts : turns) += 1;
        int lengths = 0;
        for (int i = 0; i < Model::numbers; ++i) lengths += is_length(Model::type, i);
        EXPECT_EQ(shifts, lengths) << Model::name;
        EXPECT_EQ(turns, Model::freedom - lengths) << Model::name;
        EXPECT_EQ(glides_in(Model::order), Model::glides) << Model::name;
    });
    EXPECT_FALSE(glides_in(usual_order));
}

TEST(JointModels, coordinates_are_angles_or_lengths) {
    auto const kinds = [](JointType type) {
        std::string text;
        for (int i = 0; i < numbers_of_joint(type); ++i) text += is_length(type, i) ? 'l' : 'a';
        return text;
    };
    EXPECT_EQ(kinds(JointType::revolute), "a");
    EXPECT_EQ(kinds(JointType::prismatic), "l");
    EXPECT_EQ(kinds(JointType::helical), "a");
    EXPECT_EQ(kinds(JointType::cylindrical), "al");
    EXPECT_EQ(kinds(JointType::planar3), "lla");
    EXPECT_TRUE(mixes_units(JointType::cylindrical) && mixes_units(JointType::planar3));
    EXPECT_FALSE(mixes_units(JointType::prismatic) || mixes_units(JointType::universal));
}

TEST(JointModels, mixed_chains_keep_their_order) {
    std::vector<std::string> mixed;
    for_each_joint([&](auto model) {
        if (decltype(model)::mixed) mixed.emplace_back(decltype(model)::name);
    });
    EXPECT_EQ(mixed, (std::vector<std::string>{"revolute", "universal", "spherical", "prismatic",
                                               "helical", "weld"}));
    scene::RandomChain chain;
    chain.bodies = 8;
    chain.joint = scene::RandomJoint::mixed;
    std::string names;
    for (JointType const type : scene::random_bodies(chain).joint)
        names += std::string(name_of(type)) + " ";
    EXPECT_EQ(names,
              "helical revolute spherical prismatic prismatic prismatic revolute spherical ");
}

/// Part of a velocity across the twists of a joint.
double across(std::vector<Twist> twists, Twist velocity) {
    auto const inner = [](Twist const& a, Twist const& b) {
        return dot(a.angular, b.angular) + dot(a.linear, b.linear);
    };
    auto const minus = [](Twist const& a, double factor, Twist const& b) {
        return Twist{a.angular - factor * b.angular, a.linear - factor * b.linear};
    };
    for (std::size_t i = 0; i < twists.size(); ++i) {
        Twist const& base = twists[i];
        for (std::size_t j = i + 1; j < twists.size(); ++j)
            twists[j] = minus(twists[j], inner(base, twists[j]) / inner(base, base), base);
        velocity = minus(velocity, inner(base, velocity) / inner(base, base), base);
    }
    return std::sqrt(inner(velocity, velocity));
}

/// The velocity that each coordinate gives, by differences of the joint's displacement.
TEST(JointModels, twists_span_the_motion) {
    scene::Draws draws(7, 0);
    for (int round = 0; round < 20; ++round)
        for_each_joint([&](auto model) {
            using Model = decltype(model);
            if (Model::quaternion || Model::numbers == 0) return;
            JointShape const shape = random_shape(draws, Model::glides);
            auto const q = Model::random_position(draws);
            auto const listed = Model::twists(shape, q);
            ASSERT_EQ(listed.size(), static_cast<std::size_t>(Model::freedom)) << Model::name;
            for (std::size_t i = 0; i < static_cast<std::size_t>(Model::numbers); ++i) {
                double const h = 1e-4;
                auto ahead = q, behind = q;
                ahead[i] += h, behind[i] -= h;
                auto const to = Model::displacement(shape, ahead),
                           from = Model::displacement(shape, behind);
                Vec3 const angular = (0.5 / h) * rotation_vector(to.turn * conjugate(from.turn));
                Vec3 const linear = (0.5 / h) * (to.shift - from.shift) -
                                    cross(angular, 0.5 * (to.shift + from.shift));
                EXPECT_GT(norm(angular) + norm(linear), 0.1) << Model::name;
                EXPECT_LE(across({listed.begin(), listed.end()}, {angular, linear}), 1e-7)
                    << Model::name << ", coordinate " << i;
            }
        });
    EXPECT_EQ(SphericalJoint::twists({}, {}).size(), 3U);
    EXPECT_EQ(FreeJoint::twists({}, {}).size(), 6U);
    EXPECT_TRUE(WeldJoint::twists({}, {}).empty());
}

}  // namespace
}  // namespace catena::test
