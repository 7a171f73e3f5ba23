// Implements the limits of branched chains.
#include "scene/branch_limits.hpp"

#include <algorithm>

#include "error.hpp"

namespace catena::scene {
namespace {

/// Throws InputError if the chain has bodies or a tip that branched chains do not support.
void refuse_parts(Scene const& scene, ChainSpec const& chain) {
    std::string const where = scene.file + ": chain " + chain.name;
    if (!chain.is_beads())
        throw InputError("a branched chain has rigid bodies", where,
                         "make it of point beads, or of unbranched chains");
    if (chain.tip == Tip::jointed)
        throw InputError("a branched chain has a jointed tip", where,
                         "leave out tip, or the branches");
}

}  // namespace

bool branches(ChainSpec const& chain) {
    for (std::size_t k = 1; k < chain.parent.size(); ++k)
        if (chain.parent[k] + 1 != static_cast<std::int64_t>(k)) return true;
    return false;
}

bool has_branches(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(), branches);
}

void refuse_unsupported_branches(Scene const& scene) {
    for (ChainSpec const& chain : scene.chains)
        if (branches(chain)) refuse_parts(scene, chain);
    if (!has_branches(scene)) return;
    if (scene.solver.handles != Handles::projected)
        throw InputError(
            "branched chains have projected handles only",
            scene.file + ": solver.handles: " + std::string(name_of(scene.solver.handles)),
            "use projected");
    if (scene.solver.backend == Backend::cuda_levels)
        throw InputError("branched chains are not split between GPU and host",
                         scene.file + ": solver.backend: cuda-levels", "use cuda");
}

}  // namespace catena::scene
