// Shapes, sizes and starts of generated branched chains, and the projection of a tree's links.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "generate/branched.hpp"
#include "generate/link_projection.hpp"
#include "generate/outline.hpp"
#include "reader/load_scene.hpp"
#include "scene/branches.hpp"

namespace catena::test {
namespace {

using Inboard = std::vector<std::int64_t>;

Scene scene_of(std::string const& generator, std::string const& keys = "") {
    return parse_scene("chains: [{" + keys + "generator: {" + generator + "}}]", "s.yaml");
}
ChainSpec chain_of(std::string const& generator, std::string const& keys = "") {
    return scene_of(generator, keys).chains.at(0);
}

TEST(Branched, ShapesHaveTheNumberingOfTheManual) {
    EXPECT_EQ(scene::inboard_beads(scene::Star{3, 2}, 0), (Inboard{-1, 0, 1, 0, 3, 0, 5}));
    EXPECT_EQ(scene::inboard_beads(scene::Brush{5, 2, 2}, 0),
              (Inboard{-1, 0, 1, 2, 3, 0, 5, 2, 7, 4, 9}));
    EXPECT_EQ(scene::inboard_beads(scene::Dendrimer{2, 3, 0}, 0),
              (Inboard{-1, 0, 0, 0, 1, 1, 2, 2, 3, 3}));
    EXPECT_EQ(scene::inboard_beads(scene::Dendrimer{1, 3, 1}, 0), (Inboard{-1, 0, 1, 0, 3, 0, 5}));
}

TEST(Branched, NumberOfBeadsIsThatOfTheShape) {
    for (scene::BranchedShape const& shape : std::vector<scene::BranchedShape>{
             scene::Star{5, 7}, scene::Brush{11, 3, 4}, scene::Brush{12, 3, 4},
             scene::Dendrimer{4, 4, 2}, scene::RandomTree{137, 3}})
        EXPECT_EQ(static_cast<double>(scene::inboard_beads(shape, 3).size()),
                  scene::beads_of(shape));
    EXPECT_GT(scene::beads_of(scene::Dendrimer{5000, 3, 0}), 1e300);
}

TEST(Branched, RandomTreesKeepTheirBoundAndDependOnTheSeed) {
    for (std::int64_t const most : {1, 2, 5}) {
        Inboard const inboard = scene::inboard_beads(scene::RandomTree{500, most}, 8);
        std::vector<std::int64_t> children(inboard.size(), 0);
        for (std::size_t k = 1; k < inboard.size(); ++k) {
            ASSERT_GE(inboard[k], 0);
            ASSERT_LT(inboard[k], static_cast<std::int64_t>(k));
            ++children[static_cast<std::size_t>(inboard[k])];
        }
        EXPECT_EQ(*std::max_element(children.begin(), children.end()), most);
        EXPECT_EQ(inboard, scene::inboard_beads(scene::RandomTree{500, most}, 8));
        EXPECT_EQ(most == 1, inboard == scene::inboard_beads(scene::RandomTree{500, most}, 9));
    }
}

/// Each later bead is equally likely to hang on each earlier one, if none is full.
TEST(Branched, RandomTreesDrawAllOpenBeadsEqually) {
    int constexpr trees = 3000;
    int on_first = 0, on_last = 0;
    for (std::uint64_t seed = 0; seed < trees; ++seed) {
        Inboard const inboard = scene::inboard_beads(scene::RandomTree{11, 100}, seed);
        on_first += inboard[10] == 0 ? 1 : 0, on_last += inboard[10] == 9 ? 1 : 0;
    }
    double const expected = trees / 10.0, spread = std::sqrt(expected * 0.9);
    EXPECT_NEAR(on_first, expected, 4 * spread);
    EXPECT_NEAR(on_last, expected, 4 * spread);
}

/// Largest error of a link's length, and smallest distance of beads that no link joins.
std::pair<double, double> look(ChainSpec const& chain) {
    BeadArrays const& b = chain.beads;
    double error = 0, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < b.size(); ++k) {
        std::size_t const on = scene::inboard_of(chain.parent, k);
        error = std::max(error, std::abs(norm(b.position[k] - b.position[on]) - b.length[k]));
        for (std::size_t j = 0; j < k; ++j)
            if (j != on) nearest = std::min(nearest, norm(b.position[k] - b.position[j]));
    }
    return {error, nearest};
}

TEST(Branched, StartsHaveTheirLinksAndNoOverlaps) {
    for (std::string const generator :
         {"star: {arms: 5, arm_length: 40, length: 0.97}",
          "brush: {backbone: 60, side_length: 6, length: 0.97}",
          "brush: {backbone: 60, side_length: 10, every: 3, length: 0.97}",
          "dendrimer: {generations: 4, spacer: 2, length: 0.97}",
          "random_tree: {beads: 300, length: 0.97, seed: 4}",
          "random_tree: {beads: 300, length: {uniform: [0.9, 1.1]}, mass: {normal: [5, 1]}}"}) {
        Scene const scene = scene_of(generator);
        ChainSpec const& chain = scene.chains.at(0);
        auto const [error, nearest] = look(chain);
        EXPECT_TRUE(chain.is_branched()) << generator;
        EXPECT_LE(error, 1e-13) << generator;
        EXPECT_GE(nearest, 0.969) << generator;
        EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
    }
}

TEST(Branched, FixedBasesBeginAtTheAnchor) {
    ChainSpec const chain =
        chain_of("star: {arms: 3, arm_length: 4, length: 0.5}", "base: fixed, anchor: [1, 2, 3], ");
    EXPECT_NEAR(norm(chain.beads.position[0] - Vec3{{1, 2, 3}}), 0.5, 1e-14);
    EXPECT_LE(look(chain).first, 1e-14);
}

TEST(Branched, CrowdedStartsAreNoted) {
    Scene const crowded = scene_of("star: {arms: 60, arm_length: 1, length: 1}");
    ASSERT_EQ(crowded.notes.size(), 1U);
    EXPECT_NE(crowded.notes[0].find("overlaps of beads closer than 1 nm"), std::string::npos);
    EXPECT_LE(look(crowded.chains[0]).first, 1e-14);
    EXPECT_TRUE(scene_of("star: {arms: 60, arm_length: 1, length: 1, excluded: 0}").notes.empty());
}

/// More arms than fit around the first bead: no step back helps, and the growth takes none. (It
/// took minutes once.)
TEST(Branched, StarsWithMoreArmsThanFitAreGrownWithOverlaps) {
    for (char const* const generator : {"star: {arms: 200, arm_length: 100, length: 1}",
                                        "star: {arms: 3000, arm_length: 1, length: 1}"}) {
        Scene const crowded = scene_of(generator);
        ASSERT_EQ(crowded.notes.size(), 1U) << generator;
        EXPECT_NE(crowded.notes[0].find("overlaps of beads closer than 1 nm"), std::string::npos);
        EXPECT_LE(look(crowded.chains[0]).first, 1e-13);
    }
}

/// From 13 arms on, caps of 60 degrees do not fit around a bead; 12 do.
TEST(Branched, ThirteenArmsTakeNoStepsBack) {
    for (int const arms : {12, 13, 16}) {
        auto const begin = std::chrono::steady_clock::now();
        Scene const star = scene_of("star: {arms: " + std::to_string(arms) +
                                    ", arm_length: 20, length: 1, excluded: 1}");
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5)) << arms;
        EXPECT_EQ(star.notes.size(), arms > 12 ? 1U : 0U) << arms;
        if (star.notes.empty()) continue;
        EXPECT_NE(star.notes[0].find("give a smaller `excluded`, let fewer links end on one bead"),
                  std::string::npos)
            << star.notes[0];
    }
}

TEST(Branched, CopiesDifferAndSeedsRepeat) {
    Scene const two = scene_of("random_tree: {beads: 50, length: 1, seed: 5}", "count: 2, ");
    EXPECT_NE(two.chains[0].parent, two.chains[1].parent);
    ChainSpec const again = chain_of("random_tree: {beads: 50, length: 1, seed: 5}");
    EXPECT_EQ(two.chains[0].parent, again.parent);
}

TEST(Branched, UnbranchedShapesAreUnbranchedChains) {
    EXPECT_FALSE(chain_of("star: {arms: 1, arm_length: 9, length: 1}").is_branched());
    EXPECT_FALSE(chain_of("random_tree: {beads: 9, max_children: 1, length: 1}").is_branched());
    EXPECT_EQ(chain_of("brush: {backbone: 1, side_length: 4, length: 1}").parent, Inboard{});
}

/// The tree's projection moves beads like Newton's method with the dense matrix of its links.
TEST(Branched, ProjectionIsTheLeastChange) {
    for (double const held : {1.0, 0.0}) {
        ChainSpec const chain = chain_of("random_tree: {beads: 40, length: 1, seed: 3}");
        std::vector<Vec3> at = chain.beads.position;
        for (std::size_t k = 1; k < at.size(); ++k)
            at[k] = at[k] + 1e-4 * Vec3{{std::sin(7.0 * static_cast<double>(k)),
                                         std::cos(5.0 * static_cast<double>(k)), 1}};
        std::vector<Vec3> const given = at;
        std::vector<double> mobility(at.size(), 1.0);
        mobility[0] = held;
        auto const n = static_cast<Eigen::Index>(at.size());
        Eigen::MatrixXd g = Eigen::MatrixXd::Zero(n - 1, 3 * n);
        Eigen::VectorXd error(n - 1);
        for (Eigen::Index k = 1; k < n; ++k) {
            auto const on = static_cast<Eigen::Index>(chain.parent[static_cast<std::size_t>(k)]);
            Vec3 const link = at[static_cast<std::size_t>(k)] - at[static_cast<std::size_t>(on)];
            error[k - 1] = norm(link) - 1;
            for (int i = 0; i < 3; ++i)
                g(k - 1, 3 * k + i) = link[i] / norm(link),
                                 g(k - 1, 3 * on + i) -= link[i] / norm(link);
        }
        Eigen::VectorXd inverse = Eigen::VectorXd::Ones(3 * n);
        inverse.head(3) *= held;
        Eigen::MatrixXd const moved = inverse.asDiagonal() * g.transpose();
        Eigen::VectorXd const change = -moved * (g * moved).ldlt().solve(error);
        EXPECT_TRUE(scene::LinkProjection().project(
            {at, chain.beads.length, mobility, {}, {}, 0, chain.parent}));
        for (Eigen::Index k = 0; k < n; ++k)
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(
                    at[static_cast<std::size_t>(k)][i] - given[static_cast<std::size_t>(k)][i],
                    change[3 * k + i], 1e-7);
    }
}

/// A row of units given with parents is projected like one without.
TEST(Branched, ProjectionOfARowAgreesWithTheTridiagonalOne) {
    std::vector<Vec3> row;
    for (int k = 0; k < 20; ++k)
        row.push_back({{0.9 * k, 0.3 * (k % 3), 0.2 * std::sin(static_cast<double>(k))}});
    std::vector<double> const length(row.size(), 1.0);
    Inboard parent;
    for (std::size_t k = 0; k < row.size(); ++k) parent.push_back(static_cast<std::int64_t>(k) - 1);
    std::vector<Vec3> tree = row;
    EXPECT_TRUE(scene::LinkProjection().project({row, length}));
    EXPECT_TRUE(scene::LinkProjection().project({tree, length, {}, {}, {}, 0, parent}));
    for (std::size_t k = 0; k < row.size(); ++k) EXPECT_LE(norm(row[k] - tree[k]), 1e-12);
}

/// Both arms hang on body 1: they point along x and against it.
TEST(Branched, OutlinesOfBodiesFollowBranches) {
    std::string const body = "{mass: 1, inertia: [1, 1, 1], ",
                      joint = "joint: {type: spherical, translation: ";
    Scene const scene =
        parse_scene("chains: [{base: free, bodies: [" + body + "joint: {type: free}}, " + body +
                        joint + "[2, 0, 0]}}, " + body + "parent: 1, " + joint + "[-3, 0, 0]}}]}]",
                    "s.yaml");
    scene::Outline const outline = scene::outline_of(scene.chains.at(0));
    std::vector<double> x;
    for (Vec3 const& point : outline.points) x.push_back(point[0]);
    EXPECT_EQ(x, (std::vector<double>{0, 0, 2, 2, -3, -3}));
    EXPECT_EQ(outline.link, 3);
}

}  // namespace
}  // namespace catena::test
