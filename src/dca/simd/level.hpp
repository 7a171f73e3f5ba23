// Instruction sets in which several runs of bodies are computed side by side, one in each lane of a vector.
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

}  // namespace catena
