#include "neighbours/ghosts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace catena {
namespace {

std::vector<Vec3> scattered(std::size_t n, double edge, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-edge, edge);
    std::vector<Vec3> positions;
    for (std::size_t k = 0; k < n; ++k)
        positions.push_back({{place(random), place(random), place(random)}});
    return positions;
}

std::vector<std::int64_t> by_all_pairs(std::vector<Vec3> const& x, std::int64_t first,
                                       std::int64_t last, double radius,
                                       std::optional<Vec3> const& box) {
    std::vector<std::int64_t> ghosts;
    for (std::int64_t k = 0; k < std::ssize(x); ++k) {
        if (k >= first && k < last) continue;
        bool is_near = false;
        for (std::int64_t own = first; own < last; ++own) {
            Vec3 d = x[k] - x[own];
            if (box)
                for (int i = 0; i < 3; ++i) d[i] = std::remainder(d[i], (*box)[i]);
            is_near = is_near || norm(d) < radius;
        }
        if (is_near) ghosts.push_back(k);
    }
    return ghosts;
}

std::vector<std::int64_t> run(std::int64_t first, std::int64_t last) {
    std::vector<std::int64_t> own(static_cast<std::size_t>(last - first));
    std::iota(own.begin(), own.end(), first);
    return own;
}

TEST(Ghosts, AreThoseOfAllPairs) {
    auto const positions = scattered(400, 10, 1);
    for (double const radius : {0.5, 2.0, 4.5, 50.0})
        for (auto const& [first, last] :
             {std::pair{0, 7}, {100, 150}, {399, 400}, {0, 400}, {5, 5}})
            EXPECT_EQ(ghosts_of(positions, run(first, last), radius, {}),
                      by_all_pairs(positions, first, last, radius, {}))
                << radius << ' ' << first;
}

TEST(Ghosts, InABoxTheyAreNearestImages) {
    auto const positions = scattered(300, 30, 2);  // many boxes away
    for (Vec3 const box : {Vec3{{9, 10, 11}}, Vec3{{4, 40, 7.3}}, Vec3{{3, 3, 3}}})
        for (double const radius : {0.8, 1.49, 2.5, 3.6})
            for (auto const& [first, last] : {std::pair{0, 4}, {120, 123}, {299, 300}})
                EXPECT_EQ(ghosts_of(positions, run(first, last), radius, box),
                          by_all_pairs(positions, first, last, radius, box))
                    << radius << ' ' << box[0] << ' ' << first;
}

/// Ranks find what is near each other's beads from either side: the two must agree on every pair.
TEST(Ghosts, AreFoundFromEitherSideAlike) {
    auto const here = scattered(150, 9, 4), there = scattered(150, 9, 5);
    for (std::optional<Vec3> const& box :
         {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{5, 6, 20}}}})
        for (std::size_t k = 0; k < here.size(); ++k)
            for (std::size_t i = 0; i < there.size(); ++i)
                EXPECT_EQ(near_any({&here[k], 1}, {&there[i], 1}, 2.0, box).size(),
                          near_any({&there[i], 1}, {&here[k], 1}, 2.0, box).size());
}

/// Of a cloud that touches another, in groups of chance lengths, some of them empty, on any number
/// of threads.
TEST(Ghosts, GroupsAreNearWhereOneOfTheirPointsIs) {
    auto const here = scattered(3000, 12, 6);
    auto there = scattered(2000, 12, 7);
    for (Vec3& x : there) x[0] += 24;
    std::mt19937_64 random(8);
    std::vector<std::int64_t> const of_there{0, 1, 1, 700, 2000};
    for (std::int64_t const longest : {1, 5, 60})
        for (std::optional<Vec3> const& box :
             {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{55, 25, 25}}}}) {
            std::uniform_int_distribution<std::int64_t> length(0, longest);
            std::vector<std::int64_t> first{0};
            while (first.back() < 3000)
                first.push_back(std::min<std::int64_t>(first.back() + length(random), 3000));
            std::vector<char> expected(first.size() - 1, 0);
            for (std::int64_t const k : near_any(here, there, 3.0, box))
                expected[static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), k) -
                                                  first.begin()) -
                         1] = 1;
            EXPECT_NE(std::find(expected.begin(), expected.end(), 0), expected.end());
            EXPECT_NE(std::find(expected.begin(), expected.end(), 1), expected.end());
            for (int const threads : {1, 2, 5}) {
                auto const executor =
                    openmp_is_built() ? openmp_executor(threads) : serial_executor();
                EXPECT_EQ(near_groups({here, first}, {there, of_there}, 3.0, box, *executor),
                          expected);
            }
        }
}

/// Points along curves lie together in blocks, and blocks by themselves far apart.
TEST(Ghosts, OfChainsAreThoseOfAllPairs) {
    auto const walk = [](std::uint64_t seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> place(-40, 40), step(-0.4, 0.4);
        std::vector<Vec3> x;
        for (int k = 0; k < 600; ++k) {
            if (k % 100 == 0)
                x.push_back({{place(random), place(random), place(random)}});
            else
                x.push_back(x.back() + Vec3{{step(random), step(random), step(random)}});
        }
        return x;
    };
    std::vector<Vec3> const positions = walk(9);
    for (std::optional<Vec3> const& box :
         {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{17, 14, 15}}},
          std::optional<Vec3>{Vec3{{5, 40, 6}}}})
        for (double const radius : {0.3, 1.5, 4.0, 9.0})
            EXPECT_EQ(ghosts_of(positions, run(250, 420), radius, box),
                      by_all_pairs(positions, 250, 420, radius, box))
                << radius;
}

TEST(Ghosts, DisplacementIsTheLargest) {
    auto const from = scattered(50, 1, 3);
    auto to = from;
    EXPECT_EQ(largest_displacement(from, to), 0);
    to[7] = to[7] + Vec3{{0.3, 0, 0.4}};
    to[8] = to[8] + Vec3{{0.1, 0.1, 0.1}};
    EXPECT_NEAR(largest_displacement(from, to), 0.5, 1e-15);
}

}  // namespace
}  // namespace catena
