// The contract of mpi/communicator.hpp, on however many ranks there are.
#include "mpi/communicator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "mpi/launcher.hpp"
#include "tests/mpi/world.hpp"

namespace catena::testing {

/// The same ranks, but no message longer than 5 bytes, so that all data go in pieces (with_mpi.cpp); without MPI one rank.
std::unique_ptr<Communicator> splitting_communicator();

namespace {

enum class Messages { whole, in_pieces };

class CommunicatorTest : public ::testing::TestWithParam<Messages> {
  protected:
    void SetUp() override {
        if (GetParam() == Messages::in_pieces) owner_ = splitting_communicator();
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
        for (int r = 0; r < ranks().size(); ++r) bytes.push_back(static_cast<std::int64_t>(8 * block_of(r).size()));
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
    std::int64_t const first = std::accumulate(bytes.begin(), bytes.begin() + ranks().rank(), std::int64_t{0}) / 8;
    std::vector<std::int64_t> all(expected.size(), -1);
    std::vector<std::int64_t> const block = block_of(ranks().rank());
    std::copy(block.begin(), block.end(), all.begin() + first);
    std::span<std::int64_t const> const own(all.data() + first, block.size());
    ranks().all_gather(bytes_of(own), writable(all), bytes);
    EXPECT_EQ(all, expected);
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
    EXPECT_THROW(ranks().all_gather(readable(block_of(ranks().rank())), writable(all), bytes_of_ranks()), std::logic_error);
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
    EXPECT_EQ(receive, from < 0 ? std::vector<std::int64_t>(2, -7) : std::vector<std::int64_t>(static_cast<std::size_t>(3 * from), from));
}

TEST_P(CommunicatorTest, ExchangeAroundARing) {
    int const size = ranks().size(), rank = ranks().rank();
    std::vector<std::int64_t> const send(4, rank);
    std::vector<std::int64_t> receive(4, -1);
    ranks().exchange(readable(send), (rank + 1) % size, writable(receive), (rank + size - 1) % size);
    EXPECT_EQ(receive, std::vector<std::int64_t>(4, (rank + size - 1) % size));
}

/// Rank r sends 3 r + s numbers to rank s, but nothing where r + s is a multiple of 4.
void exchange_with_everybody(std::function<void(std::span<Outgoing const>, std::span<Incoming const>)> const& exchange_all, int rank,
                             int size) {
    auto const length = [](int from, int to) { return (from + to) % 4 == 0 ? 0 : static_cast<std::size_t>(3 * from + to); };
    std::vector<std::vector<std::int64_t>> sent(static_cast<std::size_t>(size)), received(static_cast<std::size_t>(size));
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
        EXPECT_EQ(received[static_cast<std::size_t>(other)],
                  std::vector<std::int64_t>(other == rank ? 0 : length(other, rank), 100 * other + rank));
}

TEST_P(CommunicatorTest, ExchangeOfAllAtOnce) {
    exchange_with_everybody([&](auto out, auto in) { ranks().exchange_all(out, in); }, ranks().rank(), ranks().size());
    ranks().exchange_all({}, {});
}

TEST_P(CommunicatorTest, ExchangeOfAllRoundByRound) {
    exchange_with_everybody([&](auto out, auto in) { ranks().Communicator::exchange_all(out, in); }, ranks().rank(), ranks().size());
}

TEST_P(CommunicatorTest, MaxIsExactAndKnowsNegativesInfinitiesAndNaN) {
    double const infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ranks().max(-1.0 - ranks().rank()), -1.0);
    EXPECT_EQ(ranks().max(0.1 * ranks().rank()), 0.1 * (ranks().size() - 1));
    EXPECT_EQ(ranks().max(-infinity), -infinity);
    EXPECT_EQ(ranks().max(ranks().rank() == ranks().size() - 1 ? infinity : 3.0), infinity);
    EXPECT_TRUE(std::isnan(ranks().max(ranks().rank() == ranks().size() - 1 ? std::nan("") : infinity)));
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

INSTANTIATE_TEST_SUITE_P(Messages, CommunicatorTest, ::testing::Values(Messages::whole, Messages::in_pieces),
                         [](auto const& test) { return test.param == Messages::whole ? "Whole" : "InPieces"; });

}  // namespace
}  // namespace catena::testing
