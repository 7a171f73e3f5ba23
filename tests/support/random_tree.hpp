// Random branched chains of rigid bodies for tests.
#pragma once

#include "tests/support/random_chain.hpp"

namespace catena::test {

/// Shapes of random trees: each body hangs on any earlier one; mostly on the one before; on one of
/// the three before; or all on body 1.
enum class TreeShape { any, long_paths, bushy, star };

/// Returns the inboard bodies of a random tree of n bodies, as ChainSpec::parent. Trees of three
/// bodies or more branch.
inline std::vector<std::int64_t> random_parents(std::uint64_t seed, std::size_t n,
                                                TreeShape shape) {
    Random random(seed * 0x9e3779b97f4a7c15U + 7);
    std::vector<std::int64_t> parent(n, -1);
    for (std::size_t k = 1; k < n; ++k) {
        auto const before = static_cast<double>(k);
        double from = 0;
        if (shape == TreeShape::bushy) from = before > 3 ? before - 3 : 0;
        if (shape == TreeShape::long_paths && random.chance(0.9)) from = before - 1;
        parent[k] = static_cast<std::int64_t>(random.uniform(from, before));
        if (shape == TreeShape::star || k == 2) parent[k] = 0;
    }
    return parent;
}

/// Returns a random chain with the parents of a random tree.
inline ChainSpec random_tree(std::uint64_t seed, RandomChainOptions const& options,
                             TreeShape shape = TreeShape::any) {
    ChainSpec tree = random_chain(seed, options);
    if (options.bodies > 2) tree.parent = random_parents(seed, options.bodies, shape);
    return tree;
}

}  // namespace catena::test
