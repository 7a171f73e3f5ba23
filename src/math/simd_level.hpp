// Instruction sets in which several runs of bodies, merges or bodies are computed side by side, one
// in each lane of a vector.
#pragma once

#include <vector>

namespace catena {

/// Weaker ones first. off: one body after the other.
enum class SimdLevel { off, avx2, avx512 };
char const* name_of(SimdLevel);
/// Numbers a vector holds; off: 1.
int lanes_of(SimdLevel);
/// Those that this build has and this processor can run.
std::vector<SimdLevel> simd_levels();
/// The last one of these.
SimdLevel best_simd_level();
/// Whether the rest of the program rounds a product and a sum at once, as vectors do. If not, it
/// shows what goes side by side: that must not depend on ranks then.
bool rounds_as_vectors();

}  // namespace catena
