// Shares of a scene's bodies for ranks of different speed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tree/tree.hpp"

namespace catena::dca {

/// Shares of the ranks, each above 0, relative to their sum. They are integers, so that every rank
/// computes the same cuts. Empty: equal shares.
using Shares = std::vector<std::int64_t>;

/// Value of an equal share in shares_of_speeds().
inline constexpr std::int64_t parts_of_equal_share = 1000;
/// Smallest share relative to the largest one: a wrong measurement leaves no rank without work.
inline constexpr double least_of_largest_share = 0.125;

/// Returns shares proportional to the ranks' speeds (bodies per second). A speed that is not
/// positive and finite is unknown; such a rank gets the mean of the others.
Shares shares_of_speeds(std::span<double const> speeds);

/// Returns the begin of each rank's share, then the sum of shares; [ranks + 1]. Precondition: one
/// share per rank, or none.
std::vector<std::int64_t> begins_of_shares(Shares const&, int ranks);

/// Sets Partition::first_of_rank. Each indivisible part (a unit, or a chain that is too short to be
/// shared or may not be) goes to the rank whose share contains the part's middle. A rank that has
/// bodies with equal shares keeps at least one part. The trees are unchanged, and therefore the
/// bits of every solution. Precondition: one share per rank, or none.
void cut_by_shares(Partition&, int ranks, Shares const&);

}  // namespace catena::dca
