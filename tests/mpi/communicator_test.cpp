// The contract of mpi/communicator.hpp, on however many ranks there are.
#include "mpi/communicator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "mpi/cores.hpp"
#include "mpi/first_rank.hpp"
#include "mpi/launcher.hpp"
#include "tests/mpi/connection.hpp"
#include "tests/mpi/world.hpp"

namespace catena::testing {

namespace {

class CommunicatorTest : public ::testing::TestWithParam<Connection> {
  protected:
    void SetUp() override {
        if (GetParam().in_pieces || GetParam().hosts > 0) owner_ = connected(GetParam());
    }
    Communicator const& ranks() const { return owner_ ? *owner_ : world(); }

    /// Rank r's block: r + 1 numbers 100 r, 100 r + 1, ...; that of rank 1 is empty.
    static std::vector<std::int64_t> block_of(int r) {
        std::vector<std::int64_t> block(r == 1 ? 0 : static_cast<std::size_t>(r) + 1);
        std::iota(block.begin(), block.end(), 100 * r);
        return block;
    }
    std::vector<std::int64_t> bytes_of_ranks() const {
        std::vector<std::int64_t> bytes;
        for (int r = 0; r < ranks().size(); ++r)
            bytes.push_back(static_cast<std::int64_t>(8 * block_of(r).size()));
        return bytes;
    }
    std::vector<std::int64_t> all_blocks() const {
        std::vector<std::int64_t> all;
        for (int r = 0; r < ranks().size(); ++r)
            for (std::int64_t const v : block_of(r)) all.push_back(v);
        return all;
    }

  private:
    std::unique_ptr<Communicator> owner_;
};

template <class T>
std::span<std::byte> writable(std::vector<T>& values) {
    return std::as_writable_bytes(std::span(values));
}
template <class T>
std::span<std::byte const> readable(std::vector<T> const& values) {
    return bytes_of(std::span<T const>(values));
}

TEST_P(CommunicatorTest, RanksAreNumberedAndShareThisHost) {
    EXPECT_GE(ranks().rank(), 0);
    EXPECT_LT(ranks().rank(), ranks().size());
    EXPECT_EQ(ranks().size(), world().size());
    EXPECT_EQ(ranks().ranks_on_host(), ranks().size());
    EXPECT_EQ(ranks().rank_on_host(), ranks().rank());  // they are all here
    EXPECT_EQ(ranks().size(), launch_environment().size);
}

TEST_P(CommunicatorTest, AllGatherPutsBlocksInRankOrder) {
    std::vector<std::int64_t> const expected = all_blocks();
    std::vector<std::int64_t> all(expected.size(), -1);
    ranks().all_gather(readable(block_of(ranks().rank())), writable(all), bytes_of_ranks());
    EXPECT_EQ(all, expected);
}

TEST_P(CommunicatorTest, AllGatherInPlace) {
    std::vector<std::int64_t> const expected = all_blocks();
    std::vector<std::int64_t> const bytes = bytes_of_ranks();
    std::int64_t const first =
        std::accumulate(bytes.begin(), bytes.begin() + ranks().rank(), std::int64_t{0}) / 8;
    std::vector<std::int64_t> all(expected.size(), -1);
    std::vector<std::int64_t> const block = block_of(ranks().rank());
    std::copy(block.begin(), block.end(), all.begin() + first);
    std::span<std::int64_t const> const own(all.data() + first, block.size());
    ranks().all_gather(bytes_of(own), writable(all), bytes);
    EXPECT_EQ(all, expected);
}

TEST_P(CommunicatorTest, AllGatherOfBlocksOfAnySize) {
    std::mt19937 draw(11);  // the same on all ranks
    for (int i = 0; i < 60; ++i) {
        std::vector<std::int64_t> bytes;
        std::vector<std::byte> expected;
        for (int r = 0; r < ranks().size(); ++r) {
            bytes.push_back(draw() % 3 == 0 ? 0 : static_cast<std::int64_t>(draw() % 40));
            for (std::int64_t k = 0; k < bytes.back(); ++k)
                expected.push_back(static_cast<std::byte>(draw() % 256));
        }
        auto const own = static_cast<std::size_t>(ranks().rank());
        auto const first =
            std::accumulate(bytes.begin(), bytes.begin() + ranks().rank(), std::int64_t{0});
        std::vector<std::byte> all(expected.size());
        ranks().all_gather(std::span(expected).subspan(static_cast<std::size_t>(first),
                                                       static_cast<std::size_t>(bytes[own])),
                           all, bytes);
        EXPECT_EQ(all, expected);
    }
}

TEST_P(CommunicatorTest, GatherFillsRankZeroAlone) {
    bool const root = ranks().rank() == 0;
    std::vector<std::int64_t> const expected = root ? all_blocks() : std::vector<std::int64_t>{};
    std::vector<std::int64_t> all(expected.size(), -1);
    ranks().gather(readable(block_of(ranks().rank())), writable(all), bytes_of_ranks());
    EXPECT_EQ(all, expected);
}

TEST_P(CommunicatorTest, BlocksOfTheWrongLengthAreRefused) {
    std::vector<std::int64_t> all(all_blocks().size() + 1);
    EXPECT_THROW(
        ranks().all_gather(readable(block_of(ranks().rank())), writable(all), bytes_of_ranks()),
        std::logic_error);
}

TEST_P(CommunicatorTest, BroadcastComesFromRankZero) {
    std::vector<double> data(7, ranks().rank() == 0 ? 0.1 : -1.0);
    ranks().broadcast(writable(data));
    EXPECT_EQ(data, std::vector<double>(7, 0.1));
    std::vector<double> nothing;
    ranks().broadcast(writable(nothing));
}

TEST_P(CommunicatorTest, ExchangePassesDataOnWithUnequalLengths) {
    int const size = ranks().size(), rank = ranks().rank();
    int const to = rank + 1 < size ? rank + 1 : -1;
    int const from = rank - 1;
    std::vector<std::int64_t> const send(static_cast<std::size_t>(3 * rank), rank);
    std::vector<std::int64_t> receive(from < 0 ? 2 : static_cast<std::size_t>(3 * from), -7);
    ranks().exchange(readable(send), to, writable(receive), from);
    EXPECT_EQ(receive, from < 0
                           ? std::vector<std::int64_t>(2, -7)
                           : std::vector<std::int64_t>(static_cast<std::size_t>(3 * from), from));
}

TEST_P(CommunicatorTest, ExchangeAroundARing) {
    int const size = ranks().size(), rank = ranks().rank();
    std::vector<std::int64_t> const send(4, rank);
    std::vector<std::int64_t> receive(4, -1);
    ranks().exchange(readable(send), (rank + 1) % size, writable(receive),
                     (rank + size - 1) % size);
    EXPECT_EQ(receive, std::vector<std::int64_t>(4, (rank + size - 1) % size));
}

/// Rank r sends 3 r + s numbers to rank s, but nothing where r + s is a multiple of 4.
void exchange_with_everybody(
    std::function<void(std::span<Outgoing const>, std::span<Incoming const>)> const& exchange_all,
    int rank, int size) {
    auto const length = [](int from, int to) {
        return (from + to) % 4 == 0 ? 0 : static_cast<std::size_t>(3 * from + to);
    };
    std::vector<std::vector<std::int64_t>> sent(static_cast<std::size_t>(size)),
        received(static_cast<std::size_t>(size));
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    for (int other = 0; other < size; ++other) {
        auto const o = static_cast<std::size_t>(other);
        if (other == rank || (rank + other) % 4 == 0) continue;
        sent[o].assign(length(rank, other), 100 * rank + other);
        received[o].assign(length(other, rank), -1);
        out.push_back({other, readable(sent[o])});
        in.push_back({other, writable(received[o])});
    }
    std::reverse(out.begin(), out.end());  // in any order
    exchange_all(out, in);
    for (int other = 0; other < size; ++other)
        EXPECT_EQ(
            received[static_cast<std::size_t>(other)],
            std::vector<std::int64_t>(other == rank ? 0 : length(other, rank), 100 * other + rank));
}

TEST_P(CommunicatorTest, ExchangeOfAllAtOnce) {
    exchange_with_everybody([&](auto out, auto in) { ranks().exchange_all(out, in); },
                            ranks().rank(), ranks().size());
    ranks().exchange_all({}, {});
}

TEST_P(CommunicatorTest, ExchangeOfAllRoundByRound) {
    exchange_with_everybody([&](auto out, auto in) { ranks().Communicator::exchange_all(out, in); },
                            ranks().rank(), ranks().size());
}

TEST_P(CommunicatorTest, MaxIsExactAndKnowsNegativesInfinitiesAndNaN) {
    double const infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ranks().max(-1.0 - ranks().rank()), -1.0);
    EXPECT_EQ(ranks().max(0.1 * ranks().rank()), 0.1 * (ranks().size() - 1));
    EXPECT_EQ(ranks().max(-infinity), -infinity);
    EXPECT_EQ(ranks().max(ranks().rank() == ranks().size() - 1 ? infinity : 3.0), infinity);
    EXPECT_TRUE(
        std::isnan(ranks().max(ranks().rank() == ranks().size() - 1 ? std::nan("") : infinity)));
    EXPECT_TRUE(std::isnan(ranks().max(ranks().rank() == 0 ? -std::nan("") : -infinity)));
}

TEST_P(CommunicatorTest, SumOfIntegersBeyond32Bits) {
    std::int64_t const large = std::int64_t{1} << 40, size = ranks().size();
    EXPECT_EQ(ranks().sum(large + ranks().rank()), size * large + size * (size - 1) / 2);
}

TEST_P(CommunicatorTest, RoundsCountWhatWasSent) {
    std::int64_t const before = ranks().rounds();
    ranks().barrier();
    ranks().sum(1);
    std::vector<double> data(3, 1.0);
    ranks().broadcast(writable(data));
    EXPECT_EQ(ranks().rounds() - before, message_passing_library() == "none" ? 0 : 3);
}

TEST_P(CommunicatorTest, TrafficCountsGathersAndExchanges) {
    Traffic const before = ranks().traffic();
    std::vector<std::int64_t> all(all_blocks().size());
    ranks().all_gather(readable(block_of(ranks().rank())), writable(all), bytes_of_ranks());
    std::vector<double> send(3, 1.0), receive(3);
    int const inboard = ranks().rank() - 1,
              outboard = ranks().rank() + 1 < ranks().size() ? ranks().rank() + 1 : -1;
    ranks().exchange(readable(send), outboard, writable(receive), inboard);
    Traffic const counted = ranks().traffic() - before;
    if (message_passing_library() == "none") return;
    Traffic expected{1, 8 * std::ssize(all), 1, outboard < 0 ? 0 : 24};
    if (GetParam().hosts > 0) {
        std::int64_t const pieces = GetParam().in_pieces ? (8 * std::ssize(all) + 4) / 5 : 1;
        int const hosts = std::min(GetParam().hosts, ranks().size());
        bool const leads = GetParam().in_turn ? ranks().rank() < hosts
                                              : ranks().rank() * hosts % ranks().size() < hosts;
        EXPECT_EQ(ranks().gather_way().leads, leads);
        expected.host_waits = 2 * pieces;
        expected.leader_gathers = leads && hosts > 1 ? pieces : 0;
        expected.leader_bytes = leads && hosts > 1 ? 8 * std::ssize(all) : 0;
    }
    EXPECT_EQ(counted, expected);
}

TEST_P(CommunicatorTest, SaysHowItGathers) {
    GatherWay const& way = ranks().gather_way();
    int const hosts = message_passing_library() == "none" ? 0 : GetParam().hosts;
    EXPECT_EQ(way.stages, hosts > 0 ? 2 : 1);
    EXPECT_EQ(way.hosts, hosts > 0 ? std::min(hosts, ranks().size()) : 1);
    EXPECT_EQ(way.text().find("in two stages") != std::string::npos &&
                  way.text().find("by CATENA_GATHER") != std::string::npos,
              hosts > 0);
}

/// Gives the cores back.
class Bound {
  public:
    explicit Bound(int core) : before_(cores_bound_to()) {
        cpu_set_t own;
        CPU_ZERO(&own);
        CPU_SET(core, &own);
        done_ = sched_setaffinity(0, sizeof(own), &own) == 0;
    }
    ~Bound() { sched_setaffinity(0, sizeof(before_.cores), &before_.cores); }
    bool done() const { return done_; }

  private:
    CoreSet before_;
    bool done_;
};

/// Two ranks on every core of theirs, in turn, as far as there are any.
TEST(Cores, RanksBoundToTheSameOnesShareThem) {
    Communicator const& ranks = world();
    CoreSet const own = cores_bound_to();
    if (ranks.max(own.known ? 0 : 1) > 0)
        GTEST_SKIP() << "NOT RUN: the system does not tell which cores this process may run on";
    std::vector<CoreSet> all(static_cast<std::size_t>(ranks.size()));
    ranks.all_gather(std::as_bytes(std::span(&own, 1)), std::as_writable_bytes(std::span(all)),
                     std::vector<std::int64_t>(all.size(), sizeof(CoreSet)));
    auto const core_of = [&all](int rank) {
        CoreSet const& of_rank = all[static_cast<std::size_t>(rank)];
        std::vector<int> cores;
        for (int c = 0; c < CPU_SETSIZE; ++c)
            if (CPU_ISSET(c, &of_rank.cores)) cores.push_back(c);
        return cores[static_cast<std::size_t>(rank / 2) % cores.size()];
    };
    auto const sharing = [&](auto const& same) {
        int count = 0;
        for (int r = 0; r < ranks.size(); ++r) count += same(r) ? 1 : 0;
        return count;
    };
    {
        Bound const bound(core_of(ranks.rank()));
        std::unique_ptr<Communicator> const connection = connected({"bound"});
        EXPECT_TRUE(bound.done());
        EXPECT_EQ(connection->ranks_on_cores(),
                  sharing([&](int r) { return core_of(r) == core_of(ranks.rank()); }));
        EXPECT_EQ(cores_of_rank(*connection), 1);
    }
    std::unique_ptr<Communicator> const connection = connected({"as before"});
    EXPECT_EQ(connection->ranks_on_cores(),
              sharing([&](int r) { return all[static_cast<std::size_t>(r)] == own; }));
    EXPECT_EQ(cores_of_rank(*connection),
              std::max(1, CPU_COUNT(&own.cores) / connection->ranks_on_cores()));
}

/// Of rank 0, whatever the others' are.
TEST(FirstRank, ItsVariablesAreEverybodys) {
    ASSERT_EQ(setenv("CATENA_TEST_VARIABLE", world().rank() == 0 ? "first" : "other", 1), 0);
    EXPECT_EQ(variable_of_first_rank(world(), "CATENA_TEST_VARIABLE"), "first");
    ASSERT_EQ(unsetenv("CATENA_TEST_VARIABLE"), 0);
    EXPECT_EQ(variable_of_first_rank(world(), "CATENA_TEST_VARIABLE"), "");
}

/// Each set of ranks that fail; words of any length come from the first of them.
TEST(EveryRank, AFailureOfAnyIsEverybodysWithItsWords) {
    auto const words = [](int rank) {
        return std::string(static_cast<std::size_t>(7 * rank % 3 * 100),
                           static_cast<char>('a' + rank));
    };
    int const ranks = std::min(world().size(), 4);
    for (int failing = 0; failing < 1 << ranks; ++failing) {
        int calls = 0;
        std::string thrown = "nothing";
        try {
            on_every_rank(world(), [&] {
                ++calls;
                if ((failing >> world().rank() & 1) != 0)
                    throw std::runtime_error(words(world().rank()));
            });
        } catch (SharedError const& error) {
            thrown = error.what();
        }
        int first = 0;
        while (first < ranks && (failing >> first & 1) == 0) ++first;
        EXPECT_EQ(thrown, first == ranks ? "nothing" : words(first)) << failing;
        EXPECT_EQ(calls, 1);
    }
}

TEST(EveryRank, WrongInputOfTheLastRankIsWrongInputOnAll) {
    std::string thrown;
    try {
        on_every_rank(world(), [] {
            if (world().rank() == world().size() - 1) throw InputError("bad (file): mend it");
        });
    } catch (InputError const& error) {
        thrown = error.what();
    }
    EXPECT_EQ(thrown, "bad (file): mend it");
}

/// Rank r contributes r + 1 values, and rank 1 none.
TEST(Collectives, BlocksOfAnyLengthComeInRankOrder) {
    auto const block_of = [](int rank) {
        return std::vector<int>(rank == 1 ? 0 : static_cast<std::size_t>(rank) + 1, 10 * rank);
    };
    std::vector<int> all;
    for (int rank = 0; rank < world().size(); ++rank)
        for (int const value : block_of(rank)) all.push_back(value);
    auto const own = block_of(world().rank());
    EXPECT_EQ(all_gathered_blocks(world(), own).values, all);
    auto const at_first = gathered_blocks(world(), own);
    EXPECT_EQ(at_first.values, world().rank() == 0 ? all : std::vector<int>{});
    std::vector<std::vector<int>> blocks;
    if (world().rank() == 0)
        at_first.each([&](std::span<int const> b) { blocks.emplace_back(b.begin(), b.end()); });
    for (std::size_t rank = 0; rank < blocks.size(); ++rank)
        EXPECT_EQ(blocks[rank], block_of(static_cast<int>(rank)));
}

TEST(Collectives, TextsOfRankZeroTakeTheirLengthAlong) {
    for (std::string const& sent : {std::string("of rank zero"), std::string()}) {
        std::string text = world().rank() == 0 ? sent : "something much longer than that";
        broadcast(world(), text);
        EXPECT_EQ(text, sent);
    }
}

TEST(Collectives, TheFirstTextIsThatOfTheFirstRankThatHasOne) {
    int const first = world().size() / 2;
    std::string const own = world().rank() < first ? "" : std::string(5, 'a' + world().rank());
    RankText const found = first_text(world(), own);
    EXPECT_EQ(found.rank, first);
    EXPECT_EQ(found.text, std::string(5, 'a' + first));
    EXPECT_EQ(first_text(world(), "").rank, -1);
}

INSTANTIATE_TEST_SUITE_P(Connections, CommunicatorTest,
                         ::testing::Values(Connection{"Whole"}, Connection{"InPieces", true},
                                           Connection{"OneHost", false, 1},
                                           Connection{"TwoHosts", false, 2},
                                           Connection{"TwoHostsInTurn", false, 2, true},
                                           Connection{"ThreeHostsInTurnInPieces", true, 3, true},
                                           Connection{"HostsOfOne", false, 6}),
                         [](auto const& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace catena::testing
