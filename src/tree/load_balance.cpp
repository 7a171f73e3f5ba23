// Cuts a partition by the shares of the ranks, and derives shares from measured speeds.
#include "tree/load_balance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catena::dca {
namespace {

/// A chain is not shared if at least this many chains of its length make a rank's equal share. Such
/// short chains are solved without communication.
std::int64_t constexpr chains_of_share = 16;

/// Returns the first bodies of all indivisible parts (units, or chains too short to be shared),
/// then the number of bodies.
std::vector<std::int64_t> wholes_of(Partition const& partition, int ranks) {
    std::vector<std::int64_t> first;
    for (int chain = 0; chain < partition.chains(); ++chain) {
        ChainTree const& tree = partition.trees[static_cast<std::size_t>(chain)];
        bool const alone =
            partition.whole_chains || tree.bodies * ranks * chains_of_share <= partition.bodies();
        for (std::int64_t unit = 0; unit < (alone ? 1 : tree.units); ++unit)
            first.push_back(partition.first_of_chain[static_cast<std::size_t>(chain)] +
                            tree.first_body_of_unit(unit));
    }
    first.push_back(partition.bodies());
    return first;
}

/// Returns the index of each rank's first part; [ranks + 1]. A part belongs to the rank whose share
/// contains the part's middle.
std::vector<std::int64_t> deal(std::vector<std::int64_t> const& wholes,
                               std::vector<std::int64_t> const& begins) {
    auto const count = std::ssize(wholes) - 1;
    std::vector<std::int64_t> first(begins.size(), count);
    std::size_t rank = 0;
    for (std::int64_t i = 0; i < count; ++i) {
        std::int64_t const twice_middle =
            wholes[static_cast<std::size_t>(i)] + wholes[static_cast<std::size_t>(i) + 1];
        while (rank + 1 < begins.size() &&
               2 * wholes.back() * begins[rank] <= twice_middle * begins.back())
            first[rank++] = i;
    }
    return first;
}

/// Moves the cuts in `first` as little as possible so that every rank with parts by `equal` has at
/// least one.
void keep_some(std::vector<std::int64_t>& first, std::vector<std::int64_t> const& equal) {
    auto const least = [&](std::size_t rank) { return equal[rank] < equal[rank + 1] ? 1 : 0; };
    std::size_t const ranks = first.size() - 1;
    for (std::size_t r = 0; r < ranks; ++r)
        first[r + 1] = std::max(first[r + 1], first[r] + least(r));
    first[ranks] = equal[ranks];
    for (std::size_t r = ranks; r-- > 0;) first[r] = std::min(first[r], first[r + 1] - least(r));
}

}  // namespace

Shares shares_of_speeds(std::span<double const> speeds) {
    auto const is_known = [](double speed) { return speed > 0 && std::isfinite(speed); };
    double largest = 0, sum = 0;
    std::int64_t known = 0;
    for (double const speed : speeds)
        largest = is_known(speed) ? std::max(largest, speed) : largest;
    if (largest == 0) return Shares(speeds.size(), parts_of_equal_share);
    std::vector<double> weight;  // relative to the largest speed; 0: unknown
    for (double const speed : speeds) {
        weight.push_back(is_known(speed) ? std::max(least_of_largest_share, speed / largest) : 0);
        sum += weight.back();
        known += is_known(speed) ? 1 : 0;
    }
    double const mean = sum / static_cast<double>(known);
    Shares shares;
    for (double const w : weight)
        shares.push_back(
            std::llround(static_cast<double>(parts_of_equal_share) * (w > 0 ? w : mean) / mean));
    return shares;
}

std::vector<std::int64_t> begins_of_shares(Shares const& shares, int ranks) {
    std::vector<std::int64_t> begins(static_cast<std::size_t>(ranks) + 1, 0);
    if (shares.empty())
        std::iota(begins.begin(), begins.end(), 0);
    else
        std::partial_sum(shares.begin(), shares.end(), begins.begin() + 1);
    return begins;
}

void cut_by_shares(Partition& partition, int ranks, Shares const& shares) {
    std::vector<std::int64_t> const wholes = wholes_of(partition, ranks);
    std::vector<std::int64_t> const equal = deal(wholes, begins_of_shares({}, ranks));
    std::vector<std::int64_t> first =
        shares.empty() ? equal : deal(wholes, begins_of_shares(shares, ranks));
    keep_some(first, equal);
    partition.first_of_rank.clear();
    for (std::int64_t const whole : first)
        partition.first_of_rank.push_back(wholes[static_cast<std::size_t>(whole)]);
}

}  // namespace catena::dca
