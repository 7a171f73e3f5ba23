// Which particles stand for which ghosts, and which pieces of chains ghosts come in.
#include "force/ghost_slots.hpp"

#include <gtest/gtest.h>

#include "tests/force/beads.hpp"

namespace catena::testing {
namespace {

TEST(Slots, GhostsTakeThoseOfTheirKind) {
    BeadPieces const beads = single_beads({0, 1, 0, 1, 2, 0});
    GhostSlots slots(beads);
    slots.make({0, 1, 4, 0, 0}, 0);
    EXPECT_EQ(slots.particles(), 5);
    EXPECT_EQ(slots.idle().size(), 5U);
    EXPECT_TRUE(slots.take(std::vector<std::int64_t>{0, 1, 4}));
    EXPECT_EQ(slots.idle(), (std::vector<int>{3, 4}));
    EXPECT_TRUE(slots.take(std::vector<std::int64_t>{0, 2, 3}));  // 3 in the place of 1
    EXPECT_EQ(slots.particle(0), 0);
    EXPECT_EQ(slots.particle(2), 3);
    EXPECT_EQ(slots.particle(3), 1);
    EXPECT_EQ(slots.idle(), (std::vector<int>{2, 4}));
    EXPECT_FALSE(slots.take(std::vector<std::int64_t>{1, 3}));  // two of kind 1
    EXPECT_EQ(slots.particle(3), 1);
    EXPECT_TRUE(slots.take_of_any_kind(std::vector<std::int64_t>{1, 3}));
    EXPECT_EQ(slots.particle(3), 1);
    EXPECT_EQ(beads.kind[static_cast<std::size_t>(
                  slots.like()[static_cast<std::size_t>(slots.particle(1))])],
              1);
    EXPECT_EQ(slots.idle().size(), 3U);
    EXPECT_FALSE(slots.take_of_any_kind(std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
}

/// Pieces of three beads of kinds a and b, of two, and single ones.
TEST(Slots, PiecesTakeThoseOfTheirLength) {
    BeadPieces const beads{{3, 0, 0, 3, 0, 0, 3, 0, 0, 2, 0, 1, 1},
                           {7, 0, 0, 8, 0, 0, 8, 0, 0, 9, 0, 0, 1}};
    GhostSlots slots(beads);
    slots.make({0, 3, 9, 11}, 2);
    EXPECT_EQ(slots.particles(), 11);
    EXPECT_EQ(slots.like(), (std::vector<std::int64_t>{0, 0, 0, 1, 2, 3, 4, 5, 9, 10, 11}));
    EXPECT_EQ(slots.after(), (std::vector<int>{3, 4, 6, 7, 9}));
    EXPECT_EQ(slots.idle(), (std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9, 10, 0, 1}));
    EXPECT_TRUE(slots.take(std::vector<std::int64_t>{6, 9}));
    EXPECT_EQ(slots.particle(6), 5);
    EXPECT_EQ(slots.particle(9), 8);
    EXPECT_EQ(slots.idle(), (std::vector<int>{2, 3, 4, 10, 0, 1}));
    EXPECT_FALSE(slots.take(std::vector<std::int64_t>{3, 6}));
    EXPECT_TRUE(slots.take_of_any_kind(std::vector<std::int64_t>{3, 6}));
    EXPECT_EQ(slots.particle(6), 5);
    EXPECT_EQ(slots.particle(3), 2);
    EXPECT_EQ(slots.like()[2], 3);
    EXPECT_FALSE(
        slots.take_of_any_kind(std::vector<std::int64_t>{11, 12}));  // only one of that length
    EXPECT_EQ(slots.particle(3), 2);
}

/// Chains alike: where they are whole on a rank and share no term with beads elsewhere they go in
/// pieces.
TEST(Pieces, AreOfWholeChainsThatAreAlike) {
    std::string const sequence = random_sequence(70, 3);
    BeadSystem const chains = proteins(std::vector<std::string>(20, sequence));
    std::vector<int> kind;
    for (std::int64_t b = 0; b < chains.size(); ++b)
        kind.push_back(static_cast<int>(sequence[static_cast<std::size_t>(b % 70)] - 'A'));
    std::vector<char> joined(kind.size(), 0);
    joined[3 * 70 + 5] = 1;
    BeadSystem beads = split(chains, 1);
    beads.first_of_rank = {0, 9 * 70 + 20, beads.size()};  // the tenth is cut
    BeadPieces const pieces = pieces_of(beads, kind, joined);
    for (std::int64_t b = 0; b < beads.size(); ++b) {
        std::int64_t const chain = b / 70, k = b % 70;
        int const expected = chain == 3 || chain == 9 ? 1
                             : k == 0 || k == 32      ? 32
                             : k == 64                ? 6
                                                      : 0;
        EXPECT_EQ(pieces.of(b), expected) << b;
        if (expected > 1) {
            EXPECT_EQ(pieces.kind[static_cast<std::size_t>(b)],
                      pieces.kind[static_cast<std::size_t>(k)])
                << b;
        }
    }
    EXPECT_NE(pieces.kind[0], pieces.kind[32]);

    // Chains in another order on their ranks are whole all the same, unless their beads are not in
    // a row.
    for (std::int64_t c = 19; c >= 0; --c)
        for (std::int64_t k = 0; k < 70; ++k) beads.by_rank.push_back(70 * c + k);
    std::swap(beads.by_rank[0], beads.by_rank[1]);  // of the last chain
    BeadPieces const reversed = pieces_of(beads, kind, joined);
    for (std::int64_t c = 0; c < 20; ++c)
        EXPECT_EQ(reversed.of(70 * c), c == 3 || c == 10 || c == 19 ? 1 : 32) << c;

    beads.by_rank.clear();
    EXPECT_TRUE(pieces_of(beads, std::vector<int>(kind.size(), 0), joined)
                    .length.empty());  // single beads' blocks are as narrow
    for (std::int64_t c = 0; c < 20; ++c)
        kind[static_cast<std::size_t>(70 * c)] = kind[static_cast<std::size_t>(70 * c + 40)] =
            30 + static_cast<int>(c);
    EXPECT_TRUE(
        pieces_of(beads, kind, joined).length.empty());  // no two pieces are alike but the shortest
}

}  // namespace
}  // namespace catena::testing
