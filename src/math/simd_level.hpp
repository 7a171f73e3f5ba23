// Instruction sets with which several items (bodies, merges or runs of bodies) are computed at
// once, one in each vector lane.
#pragma once

#include <vector>

namespace catena {

/// Instruction sets in ascending order. off: one body after the other.
enum class SimdLevel { off, avx2, avx512 };
/// Name of the level in input files and reports.
char const* name_of(SimdLevel);
/// Number of doubles in a vector; 1 if off.
int lanes_of(SimdLevel);
/// Returns the levels that this build contains and this processor supports, in ascending order.
std::vector<SimdLevel> simd_levels();
/// Returns the last of simd_levels().
SimdLevel best_simd_level();
/// True if scalar code contracts a product and a sum to one rounding, as the vector code does. If
/// false, results depend on which items share a vector; that grouping must then not depend on
/// ranks.
bool rounds_as_vectors();

}  // namespace catena
