// Neighbouring chains of a scene that are alike, for words and tables.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::scene {

/// Chains [first, first + count) of the scene, which differ in name, state and parameters alone.
struct AlikeChains {
    std::size_t first = 0, count = 0;
};
/// Returns the chains of the first replica as runs of alike ones, in their order. Chains are alike
/// if size, contents, base, tip and kind of handles are equal.
std::vector<AlikeChains> alike_chains(Scene const&);

/// Returns "beads", "bodies" or "bodies and beads".
char const* contents_of(ChainSpec const&);
/// Returns "free", the type of the tip's joint, or "ring, " with that type.
std::string tip_name(ChainSpec const&);

/// Returns the chains in words: "20 chains of 163 beads (fus-1 to fus-20)". Alike chains are named
/// once, and long lists end with a count. Chains of a replica count once: "1 chain of 140 beads
/// (asyn); 256 replicas".
std::string chains_text(Scene const&);

}  // namespace catena::scene
