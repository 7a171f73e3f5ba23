// Degrees of freedom of loops, as the program counts them, against the rank of the dense Jacobian.
#include <fmt/format.h>

#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "tests/oracle/compare.hpp"
#include "tests/oracle/loop_rank.hpp"

namespace catena::test {
namespace {

/// A joint type with its axes along the normal n of a plane, along x in that plane, or oblique.
std::string axes_of(std::string const& type, std::string const& direction) {
    std::string const axis = direction == "n"   ? "[0.36, 0.48, 0.8]"
                             : direction == "x" ? "[0.8, -0.6, 0]"
                                                : "[0.48, 0.64, -0.6]";
    std::string const across = direction == "x" ? "[0.36, 0.48, 0.8]" : "[0.8, -0.6, 0]";
    if (type == "weld" || type == "spherical") return "{type: " + type;
    if (type == "planar3" || type == "universal")
        return fmt::format("{{type: {}, axes: [{}, {}]", type, across, axis);
    return fmt::format("{{type: {}, axis: {}{}", type, axis,
                       type == "helical" ? ", pitch: 0.3" : "");
}
/// Position of a joint away from its rest.
std::string position_of(std::string const& type, std::size_t k) {
    double const q = 0.2 + 0.1 * static_cast<double>(k);
    if (type == "weld" || type == "spherical") return "";
    if (type == "planar3") return fmt::format(", q: [{}, 0.2, {}]", q, 2 * q);
    if (type == "universal" || type == "cylindrical") return fmt::format(", q: [{}, 0.3]", q);
    return fmt::format(", q: {}", q);
}

struct Kind {
    std::string type, direction;
};
/// A chain on the ground with these joints one after the other, and a joint at its tip.
ChainSpec bridge(std::vector<Kind> const& joints, Kind const& tip) {
    std::string bodies;
    for (std::size_t k = 0; k < joints.size(); ++k)
        bodies += fmt::format(
            "{}{{mass: 1, com: [0.5, 0.1, 0], inertia: [0.5, 0.6, 0.7], joint: {}, translation: "
            "[1, 0.1, 0.2]{}}}}}",
            k == 0 ? "" : ", ", axes_of(joints[k].type, joints[k].direction),
            position_of(joints[k].type, k));
    return parse_scene("units: si\nchains: [{base: fixed, bodies: [" + bodies + "], tip: {joint: " +
                           axes_of(tip.type, tip.direction) + ", translation: [1, 0, 0.1]}}}]\n",
                       "bridge.yaml")
        .chains.at(0);
}
/// Coordinates of the chain's joints without prescribed motion.
std::int64_t coordinates(ChainSpec const& chain) {
    std::int64_t all = 0;
    for (JointType const type : chain.bodies.joint) all += scene::coordinates_of(type);
    for (DrivenJoint const& driven : chain.bodies.driven)
        all -= scene::coordinates_of(chain.bodies.joint[static_cast<std::size_t>(driven.body)]);
    return all;
}
/// Directions that the tip restricts, as the program counts.
std::int64_t restricted(ChainSpec const& chain) {
    return coordinates(chain) - scene::degrees_of_freedom(chain);
}

std::vector<Kind> const tips{{"revolute", "n"},  {"spherical", "n"},  {"cylindrical", "n"},
                             {"planar3", "n"},   {"weld", "n"},       {"prismatic", "n"},
                             {"helical", "n"},   {"universal", "n"},  {"revolute", "x"},
                             {"prismatic", "x"}, {"planar3", "x"},    {"cylindrical", "x"},
                             {"revolute", "o"},  {"cylindrical", "o"}};

/// Five revolute joints about n, among them another joint, first, in the middle or last. Joints
/// that leave the group, at an end and with such a tip, make a loop of three parts: then the count
/// is an upper bound.
TEST(LoopFreedom, is_the_rank_that_the_jacobian_lacks) {
    std::vector<Kind> const others{{"revolute", "n"},  {"cylindrical", "n"}, {"prismatic", "n"},
                                   {"prismatic", "x"}, {"prismatic", "o"},   {"helical", "n"},
                                   {"planar3", "n"},   {"planar3", "x"},     {"weld", "n"},
                                   {"spherical", "n"}, {"cylindrical", "x"}, {"revolute", "o"},
                                   {"universal", "n"}};
    int exact = 0, bounds = 0;
    for (std::size_t i = 0; i < others.size(); ++i)
        for (std::size_t const place : {0U, 2U, 5U}) {
            std::vector<Kind> joints(5, {"revolute", "n"});
            joints.insert(joints.begin() + static_cast<std::ptrdiff_t>(place), others[i]);
            for (Kind const& tip : tips) {
                SCOPED_TRACE(fmt::format("{} {} at {}, tip {} {}", others[i].type,
                                         others[i].direction, place, tip.type, tip.direction));
                ChainSpec const chain = bridge(joints, tip);
                bool const three_parts = i >= 10 && place != 2;
                if (three_parts)
                    EXPECT_GE(restricted(chain), closure_rank(chain));
                else
                    EXPECT_EQ(restricted(chain), closure_rank(chain));
                ++(three_parts ? bounds : exact);
            }
        }
    EXPECT_EQ(exact, (10 * 3 + 3) * 14);
    EXPECT_EQ(bounds, 3 * 2 * 14);
}

/// Rotations about one axis and all translations: a group of four directions.
TEST(LoopFreedom, joints_that_slide_along_the_common_axis_leave_two_directions_out) {
    for (Kind const& sliding :
         {Kind{"cylindrical", "n"}, Kind{"prismatic", "n"}, Kind{"helical", "n"}}) {
        std::vector<Kind> joints(5, {"revolute", "n"});
        joints[1] = sliding;
        EXPECT_EQ(restricted(bridge(joints, {"revolute", "n"})), 3) << sliding.type;
        EXPECT_EQ(restricted(bridge(joints, {"spherical", "n"})), 3) << sliding.type;
        EXPECT_EQ(restricted(bridge(joints, {"cylindrical", "n"})), 2) << sliding.type;
        EXPECT_EQ(restricted(bridge(joints, {"planar3", "n"})), 1) << sliding.type;
        EXPECT_EQ(restricted(bridge(joints, {"weld", "n"})), 4) << sliding.type;
        EXPECT_EQ(restricted(bridge(joints, {"revolute", "o"})), 4) << sliding.type;
    }
    std::vector<Kind> const four_bar{{"cylindrical", "n"}, {"revolute", "n"}, {"revolute", "n"}};
    EXPECT_EQ(scene::degrees_of_freedom(bridge(four_bar, {"revolute", "n"})), 1);
    EXPECT_EQ(scene::degrees_of_freedom(bridge(
                  {{"prismatic", "x"}, {"revolute", "n"}, {"revolute", "n"}}, {"revolute", "n"})),
              1);  // slider-crank
}

/// Chains of more than 32 bodies, cut at the tip only.
TEST(LoopFreedom, of_long_chains_is_that_of_their_group) {
    for (Kind const& other : {Kind{"revolute", "n"}, Kind{"cylindrical", "n"}, Kind{"helical", "n"},
                              Kind{"planar3", "n"}, Kind{"prismatic", "x"}, Kind{"revolute", "o"}})
        for (Kind const& tip : tips) {
            std::vector<Kind> joints(60, {"revolute", "n"});
            joints[30] = other;
            ChainSpec const chain = bridge(joints, tip);
            EXPECT_EQ(restricted(chain), closure_rank(chain))
                << other.type << " " << other.direction << ", tip " << tip.type << " "
                << tip.direction;
        }
}

/// Groups of other directions: translations alone, screws of one pitch, rotations about a point.
TEST(LoopFreedom, of_other_groups) {
    std::vector<Kind> const slides{
        {"prismatic", "x"}, {"prismatic", "n"}, {"prismatic", "o"}, {"prismatic", "x"}};
    std::vector<Kind> const level{{"prismatic", "x"}, {"prismatic", "o"}, {"prismatic", "x"}};
    std::vector<Kind> const screws(5, {"helical", "n"});
    for (auto const& joints : {slides, level, screws})
        for (Kind const& tip : tips) {
            ChainSpec const chain = bridge(joints, tip);
            EXPECT_EQ(restricted(chain), closure_rank(chain))
                << joints[1].type << ", tip " << tip.type << " " << tip.direction;
        }
    EXPECT_EQ(restricted(bridge(screws, {"helical", "n"})), 2);
    EXPECT_EQ(restricted(bridge({{"spherical", "n"}}, {"spherical", "n"})), 2);  // a rod
    EXPECT_EQ(restricted(bridge({{"revolute", "n"}}, {"cylindrical", "n"})), 1);
}

/// A straight chain of parallel revolute joints has a lower rank at the start, but moves in a
/// plane from there.
TEST(LoopFreedom, is_that_of_the_positions_nearby) {
    std::string const z =
        "{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1], "
        "translation: [1, 0, 0]}}";
    ChainSpec const chain =
        parse_scene("units: si\nchains: [{base: fixed, bodies: [" + z + ", " + z + ", " + z + ", " +
                        z +
                        "], tip: {joint: {type: revolute, axis: [0, 0, 1], translation: [1, 0, "
                        "0]}}}]\n",
                    "straight.yaml")
            .chains.at(0);
    EXPECT_EQ(closure_rank(chain), 1);
    EXPECT_EQ(scene::degrees_of_freedom(chain), 2);
}

/// A regular polygon of bars of length 1, far from the origin; its joints turn about z.
ChainSpec polygon(int bars, std::string const& closing) {
    double const turn = 2 * std::acos(-1.0) / bars;
    std::string const body = "{mass: 1, com: [0.5, 0.1, 0], inertia: [0.5, 0.6, 0.7], joint: ";
    std::string bodies = body + "{type: free, q: {position: [1e5, 2e5, -3e5]}}}";
    for (int k = 1; k < bars; ++k)
        bodies += fmt::format(
            ", {}{{type: revolute, axis: [0, 0, 1], translation: [1, 0, 0], q: {:.17g}}}}}", body,
            turn);
    return parse_scene("units: si\nchains: [{base: free, bodies: [" + bodies +
                           "], tip: {ring: {translation: [1, 0, 0], type: " + closing + "}}}]\n",
                       "polygon.yaml")
        .chains.at(0);
}

TEST(LoopFreedom, of_rings_leaves_the_first_bodys_own_joint_out) {
    for (auto const& [closing, rank] :
         {std::pair{"revolute, axis: [0, 0, 1]", 2}, std::pair{"spherical", 2},
          std::pair{"planar3, axes: [[1, 0, 0], [0, 0, 1]]", 0},
          std::pair{"cylindrical, axis: [0, 0, 1]", 2}, std::pair{"weld", 3},
          std::pair{"prismatic, axis: [1, 0, 0]", 2}}) {
        for (int const bars : {6, 50}) {
            ChainSpec const ring = polygon(bars, closing);
            EXPECT_EQ(closure_rank(ring), rank) << closing;
            EXPECT_EQ(restricted(ring), rank) << closing;
        }
    }
}

TEST(LoopFreedom, of_random_loops) {
    RandomJoints const kinds[] = {
        RandomJoints::revolute, RandomJoints::spherical,   RandomJoints::mixed,
        RandomJoints::weld,     RandomJoints::prismatic,   RandomJoints::helical,
        RandomJoints::any,      RandomJoints::cylindrical, RandomJoints::planar3,
        RandomJoints::planar,   RandomJoints::all};
    JointType const closing[] = {JointType::spherical, JointType::revolute,   JointType::universal,
                                 JointType::weld,      JointType::planar3,    JointType::helical,
                                 JointType::prismatic, JointType::cylindrical};
    for (std::uint64_t seed = 0; seed < 176; ++seed) {
        ChainSpec const chain =
            random_chain(seed, {.bodies = seed % 4 < 2 ? 24U : 40U,
                                .joints = kinds[seed % std::size(kinds)],
                                .base = seed % 3 == 0 ? Base::free : Base::fixed,
                                .tip = closing[seed / 11 % 8],
                                .ring = seed % 6 == 0});
        EXPECT_EQ(restricted(chain), closure_rank(chain)) << seed;
    }
}

}  // namespace
}  // namespace catena::test
