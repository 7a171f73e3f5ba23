// How many of a scene's bodies each rank gets where ranks are not equally fast.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tree/tree.hpp"

namespace catena::dca {

/// Of each rank, above 0, in parts of their sum: whole numbers, with which every rank makes the
/// same cuts. Empty: equal shares.
using Shares = std::vector<std::int64_t>;

/// What an equal share is in shares_of_speeds().
inline constexpr std::int64_t parts_of_equal_share = 1000;
/// No share is smaller than this part of the largest: a wrong measurement starves nobody.
inline constexpr double least_of_largest_share = 0.125;

/// In proportion to the ranks' speeds (bodies a second). A speed that is not above 0 and finite is
/// not known: such a rank counts as the mean of the others.
Shares shares_of_speeds(std::span<double const> speeds);

/// Where each rank's share begins, and the sum; [ranks + 1]. Precondition: one share a rank, or
/// none.
std::vector<std::int64_t> begins_of_shares(Shares const&, int ranks);

/// Sets Partition::first_of_rank: what goes to one rank, a unit or a chain too short to be shared,
/// goes to the one within whose share its middle lies; but ranks that have bodies with equal shares
/// keep some. The trees stay, and with them the bits of every solution. Precondition: as
/// begins_of_shares().
void cut_by_shares(Partition&, int ranks, Shares const&);

}  // namespace catena::dca
