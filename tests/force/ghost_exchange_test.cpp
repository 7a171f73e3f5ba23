// Ghosts are those that a search among all beads finds, and stand where their beads do, on any
// number of ranks.
#include "neighbours/ghost_exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "mpi/first_rank.hpp"
#include "neighbours/ghosts.hpp"
#include "tests/force/ranks.hpp"

namespace catena::testing {
namespace {

double constexpr reach = 2, skin = 0.5;

/// Beads of a scene on some ranks, each of which knows where all of them are.
struct Beads {
    Beads(std::int64_t count, double edge, Communicator const& communicator, bool shuffled = false)
        : rank(communicator.rank()), random(7), positions(static_cast<std::size_t>(count)) {
        std::uniform_real_distribution<double> place(0, edge);
        for (Vec3& x : positions)
            for (double& c : x.data) c = place(random);
        for (int r = 0; r <= communicator.size(); ++r)
            plan.first_of_rank.push_back(count * r / communicator.size());
        if (shuffled) {
            for (std::int64_t k = 0; k < count; ++k) plan.by_rank.push_back(k);
            std::shuffle(plan.by_rank.begin(), plan.by_rank.end(), random);
        }
        plan.ranges = {{reach, {}}};
        plan.skin = skin;
    }

    std::vector<std::int64_t> own_beads() const {
        std::vector<std::int64_t> own;
        for (std::int64_t i = plan.first_of_rank[rank]; i < plan.first_of_rank[rank + 1]; ++i)
            own.push_back(plan.by_rank.empty() ? i : plan.by_rank[i]);
        return own;
    }
    std::vector<Vec3> own() const {
        std::vector<Vec3> x;
        for (std::int64_t const k : own_beads()) x.push_back(positions[k]);
        return x;
    }
    void walk(double stride) {
        std::uniform_real_distribution<double> step(-stride, stride);
        for (Vec3& x : positions)
            for (double& c : x.data) c += step(random);
    }
    std::vector<std::int64_t> piece_with(std::int64_t bead) const {
        std::int64_t first = bead;
        while (!plan.piece.empty() && plan.piece[static_cast<std::size_t>(first)] == 0) --first;
        std::vector<std::int64_t> all(
            plan.piece.empty() ? 1 : plan.piece[static_cast<std::size_t>(first)]);
        std::iota(all.begin(), all.end(), first);
        return all;
    }
    /// All ghosts that act within the ranges' reach and so much more, or are in a piece with one,
    /// partners included.
    std::vector<std::int64_t> expected(double more) const {
        std::set<std::int64_t> all(plan.partners.begin(), plan.partners.end());
        for (PairRange const& range : plan.ranges) {
            std::vector<std::int64_t> acting,
                own;  // of `there`: numbers among all; own ones by their places in it
            std::vector<Vec3> there;
            for (std::int64_t k = 0; k < std::ssize(positions); ++k)
                if (range.is_for(k)) {
                    acting.push_back(k);
                    there.push_back(positions[k]);
                }
            for (std::int64_t const k : own_beads())
                if (range.is_for(k))
                    own.push_back(std::lower_bound(acting.begin(), acting.end(), k) -
                                  acting.begin());
            for (std::int64_t const i : ghosts_of(there, own, range.reach + more, plan.box))
                for (std::int64_t const k : piece_with(acting[i])) all.insert(k);
        }
        return {all.begin(), all.end()};
    }

    int rank;
    GhostLists::Plan plan;
    std::mt19937_64 random;
    std::vector<Vec3> positions;
};

std::vector<std::int64_t> sorted(std::vector<std::int64_t> values) {
    std::sort(values.begin(), values.end());
    return values;
}

/// Whether `call` fails with words that contain `text`.
template <class Call>
bool fails_with(std::string const& text, Call call) {
    try {
        call();
    } catch (SharedError const& e) {
        return std::string(e.what()).find(text) != std::string::npos;
    }
    return false;
}

/// Lists fresh at the first evaluation, complete at the others; the number of times they were made.
std::int64_t walk_along(Beads& beads, Communicator const& communicator, int steps, double stride) {
    GhostExchange ghosts(communicator, beads.plan);
    for (int n = 0; n < steps; ++n) {
        ghosts.update(beads.own());
        if (n == 0) {
            EXPECT_EQ(sorted(ghosts.beads()), beads.expected(skin));
        }
        auto const held = sorted(ghosts.beads()), needed = beads.expected(0);
        EXPECT_TRUE(std::includes(held.begin(), held.end(), needed.begin(), needed.end()))
            << "step " << n;
        for (std::size_t i = 0; i < ghosts.beads().size(); ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(ghosts.positions()[i][c], beads.positions[ghosts.beads()[i]][c]);
        EXPECT_NO_THROW(ghosts.audit(beads.own()));
        beads.walk(stride);
    }
    return ghosts.traffic().rebuilds;
}

TEST(GhostExchange, HoldsWhatIsNear) {
    on_ranks([](Communicator const& communicator) {
        for (bool const shuffled : {false, true}) {
            Beads beads(200, 12, communicator, shuffled);
            std::int64_t const rebuilds = walk_along(beads, communicator, 40, 0.02);
            EXPECT_GT(rebuilds, 1);
            EXPECT_LT(rebuilds, 40);
        }
    });
}

TEST(GhostExchange, HoldsNearestImagesInABox) {
    on_ranks([](Communicator const& communicator) {
        for (Vec3 const& box : {Vec3{{12, 12, 12}}, Vec3{{30, 5, 5}}, Vec3{{4, 4, 40}}}) {
            Beads beads(150, 50, communicator, true);  // some are boxes away
            beads.plan.box = box;
            EXPECT_GT(walk_along(beads, communicator, 30, 0.03), 1);
        }
    });
}

/// Of four beads, or of one and three, scattered far from each other or not.
TEST(GhostExchange, PiecesAreGhostsAsAWhole) {
    on_ranks([](Communicator const& communicator) {
        std::pair<std::optional<Vec3>, double> const cases[] = {
            {std::nullopt, 1.0}, {std::nullopt, 9.0}, {Vec3{{60, 12, 12}}, 1.0}};
        for (auto const& [box, width] : cases) {
            Beads beads(240, 12, communicator);
            beads.plan.box = box;
            std::uniform_real_distribution<double> off(-width, width);
            for (std::int64_t k = 0; k < 240; ++k) {
                beads.plan.piece.push_back(k % 4 == 0 ? k % 20 == 0 ? 1 : 4 : k % 20 == 1 ? 3 : 0);
                if (beads.plan.piece.back() == 0)
                    beads.positions[k] =
                        beads.positions[k - 1] +
                        Vec3{{off(beads.random), off(beads.random), off(beads.random)}};
            }
            PairRange few{reach, {}};
            for (std::int64_t k = 0; k < 240; ++k) few.acts.push_back(k % 3 == 0 ? 1 : 0);
            beads.plan.ranges = {few, {0.4 * reach, {}}};
            Beads single = beads;
            single.plan.piece.clear();
            if (communicator.size() > 1) {
                EXPECT_GT(beads.expected(skin).size(), single.expected(skin).size());
            }
            walk_along(beads, communicator, 20, 0.03);
        }
    });
}

TEST(GhostExchange, BeadsThatActNotSoFarAreGhostsNearbyAlone) {
    on_ranks([](Communicator const& communicator) {
        for (std::optional<Vec3> const& box :
             {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{60, 12, 12}}}}) {
            Beads beads(300, 12, communicator, true);
            beads.plan.box = box;
            PairRange few{reach, {}};
            for (std::int64_t k = 0; k < 300; ++k) few.acts.push_back(k % 3 == 0 ? 1 : 0);
            beads.plan.ranges = {few, {0.4 * reach, {}}};
            walk_along(beads, communicator, 40, 0.02);
            Beads all = beads;
            all.plan.ranges = {{reach, {}}};
            if (communicator.size() > 1) {
                EXPECT_LT(beads.expected(0).size(), all.expected(0).size());
            }
        }
    });
}

/// Where a rank's beads leave no cell of the box free, beads are looked for over the longest range,
/// and some are none's ghosts still.
TEST(GhostExchange, SeveralRangesInAFullBox) {
    on_ranks([](Communicator const& communicator) {
        Beads beads(60, 9, communicator, true);
        beads.plan.box = Vec3{{9, 9, 9}};
        PairRange few{reach, {}};
        for (std::int64_t k = 0; k < 60; ++k) few.acts.push_back(k % 3 == 0 ? 1 : 0);
        beads.plan.ranges = {few, {0.4 * reach, {}}};
        GhostExchange ghosts(communicator, beads.plan);
        for (int n = 0; n < 20; ++n) {
            ghosts.update(beads.own());
            auto const held = sorted(ghosts.beads()), needed = beads.expected(0);
            EXPECT_TRUE(std::includes(held.begin(), held.end(), needed.begin(), needed.end()))
                << "step " << n;
            EXPECT_NO_THROW(ghosts.audit(beads.own()));
            auto const own = beads.own();
            if (!own.empty() && own.size() + held.size() < beads.positions.size()) {
                Vec3 const place = ghosts.aside(0, 1);
                EXPECT_TRUE(near_any({&place, 1}, own, reach, beads.plan.box).empty());
            }
            beads.walk(0.05);
        }
    });
}

TEST(GhostExchange, PartnersAreGhostsWhereverTheyAre) {
    on_ranks([](Communicator const& communicator) {
        Beads beads(60, 40, communicator);
        // Bead k and bead 59 - k are partners.
        std::vector<std::int64_t> const own = beads.own_beads();
        for (std::int64_t const k : own)
            if (std::find(own.begin(), own.end(), 59 - k) == own.end())
                beads.plan.partners.push_back(59 - k);
        std::sort(beads.plan.partners.begin(), beads.plan.partners.end());
        walk_along(beads, communicator, 10, 0.1);
        beads.plan.ranges.clear();
        GhostExchange ghosts(communicator, beads.plan);
        for (int n = 0; n < 5; ++n) {
            ghosts.update(beads.own());
            EXPECT_EQ(ghosts.beads(), beads.plan.partners);
            EXPECT_NO_THROW(ghosts.audit(beads.own()));
            beads.walk(1);
        }
        EXPECT_EQ(ghosts.traffic().rebuilds, 1);
    });
}

TEST(GhostExchange, NothingIsFeltAside) {
    on_ranks([](Communicator const& communicator) {
        for (std::optional<Vec3> const& box :
             {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{40, 12, 12}}},
              std::optional<Vec3>{Vec3{{9, 9, 9}}}}) {
            Beads beads(40, 9, communicator);
            beads.plan.box = box;
            GhostExchange ghosts(communicator, beads.plan);
            ghosts.update(beads.own());
            auto const own = beads.own();
            if (own.empty() ||
                std::ssize(own) + std::ssize(ghosts.beads()) == std::ssize(beads.positions))
                continue;
            for (std::int64_t i = 0; i < 30; ++i) {
                Vec3 const place = ghosts.aside(i, 30);
                EXPECT_TRUE(near_any({&place, 1}, own, reach + skin / 2, box).empty()) << i;
            }
        }
    });
}

TEST(GhostExchange, RanksWithoutBeads) {
    on_ranks([](Communicator const& communicator) {
        for (std::int64_t const count : {0, 1, 2, 5}) {
            Beads beads(count, 3, communicator);
            walk_along(beads, communicator, 5, 0.2);
        }
    });
}

TEST(GhostExchange, OnlyRanksThatAreNearSpeak) {
    on_ranks([](Communicator const& communicator) {
        Beads beads(240, 4, communicator);
        std::vector<std::int64_t> const& first = beads.plan.first_of_rank;
        for (int r = 0; r < communicator.size(); ++r)
            for (std::int64_t k = first[r]; k < first[r + 1]; ++k)
                beads.positions[k][0] += 4.0 * r;  // in a row, each as long as 2 reaches
        GhostExchange ghosts(communicator, beads.plan);
        ghosts.update(beads.own());
        std::int64_t const before = ghosts.traffic().messages;
        ghosts.update(beads.own());
        int const neighbours = (communicator.rank() > 0 ? 1 : 0) +
                               (communicator.rank() + 1 < communicator.size() ? 1 : 0);
        EXPECT_EQ(ghosts.traffic().messages - before, neighbours);
        EXPECT_EQ(ghosts.traffic().rebuilds, 1);
        EXPECT_LT(std::ssize(ghosts.beads()),
                  240 - std::ssize(beads.own()) + (communicator.size() <= 2 ? 1 : 0));
    });
}

TEST(GhostExchange, IsMadeAnewWhenAsked) {
    on_ranks([](Communicator const& communicator) {
        Beads beads(100, 8, communicator);
        GhostExchange ghosts(communicator, beads.plan);
        for (int n = 0; n < 6; ++n) {
            if (n % 2 == 0) ghosts.renew();
            ghosts.update(beads.own());
        }
        EXPECT_EQ(ghosts.traffic().rebuilds, 3);
    });
}

/// Beads that were moved behind the lists' back are found out by the audit.
TEST(GhostExchange, TheAuditFindsWhatIsMissedOrStale) {
    on_ranks([](Communicator const& communicator) {
        if (communicator.size() == 1) return;
        Beads beads(100, 30, communicator);
        GhostExchange ghosts(communicator, beads.plan);
        ghosts.update(beads.own());
        EXPECT_NO_THROW(ghosts.audit(beads.own()));
        Beads moved = beads;
        moved.positions.back() = moved.positions.front() +
                                 Vec3{{0.5 * reach, 0, 0}};  // of the last rank, to the first one's
        EXPECT_TRUE(fails_with("acts on a rank that has no ghost of it",
                               [&] { ghosts.audit(moved.own()); }));
        ghosts.renew();
        ghosts.update(moved.own());
        EXPECT_NO_THROW(ghosts.audit(moved.own()));
        moved.positions.back()[1] += 1e-12;
        EXPECT_TRUE(fails_with("a ghost of bead 100 is not at the bead's position",
                               [&] { ghosts.audit(moved.own()); }));
    });
}

TEST(GhostExchange, APositionThatIsNotFiniteIsEverybodysMessage) {
    on_ranks([](Communicator const& communicator) {
        Beads beads(30, 5, communicator);
        GhostExchange ghosts(communicator, beads.plan);
        ghosts.update(beads.own());
        beads.positions[17][2] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_TRUE(fails_with("the position of bead 18 is not finite",
                               [&] { ghosts.update(beads.own()); }));
    });
}

}  // namespace
}  // namespace catena::testing
