// Implements the limits of branched chains.
#include "scene/branch_limits.hpp"

#include <algorithm>

#include "error.hpp"

namespace catena::scene {
namespace {

/// Throws InputError if the chain has bodies or a tip that branched or cross-linked chains do not
/// support.
void refuse_parts(Scene const& scene, ChainSpec const& chain) {
    std::string const where = scene.file + ": chain " + chain.name,
                      what = std::string("a ") + kind_of_paths(chain) + " chain has ",
                      part = branches(chain) ? "branches" : "cross-links";
    if (!chain.is_beads() && !is_body_tree(chain))
        throw InputError(what + "rigid bodies", where,
                         "make it of point beads, or leave out the " + part);
    if (chain.tip == Tip::jointed)
        throw InputError(what + "a jointed tip", where, "leave out tip, or the " + part);
}

/// Throws InputError if the scene has handles or an integrator that branched chains of rigid bodies
/// do not support.
void refuse_of_body_tree(Scene const& scene, ChainSpec const& chain) {
    std::string const these = "branched chains of rigid bodies ";
    if (scene.solver.handles == Handles::full)
        throw InputError(these + "have articulated handles only",
                         scene.file + ": solver.handles: full",
                         "use articulated, or leave handles out");
    if (chain.bodies.carried.size() > 0)
        throw InputError(these + "carry no beads in this version",
                         scene.file + ": chain " + chain.name, "leave out beads, or parent");
    if (!scene.dynamics.given) return;
    std::string const integrator = name_of(scene.dynamics.integrator),
                      where = scene.file + ": dynamics.integrator: " + integrator;
    if (!uses_joint_coordinates(scene.dynamics.integrator))
        throw InputError(these + "move in joint coordinates only", where,
                         "use rk4, dormand-prince, velocity-verlet, leapfrog or baoab");
    if (is_implicit(scene.dynamics.integrator))
        throw InputError(these + "have no implicit springs and dampers in this version", where,
                         "use rk4, dormand-prince, velocity-verlet, leapfrog or baoab");
}

}  // namespace

bool branches(ChainSpec const& chain) {
    for (std::size_t k = 1; k < chain.parent.size(); ++k)
        if (chain.parent[k] + 1 != static_cast<std::int64_t>(k)) return true;
    return false;
}

bool is_body_tree(ChainSpec const& chain) { return chain.bodies.size() > 0 && branches(chain); }

bool has_branches(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(), branches);
}

bool goes_by_paths(ChainSpec const& chain) { return chain.is_cross_linked() || branches(chain); }

bool has_paths(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(), goes_by_paths);
}

char const* kind_of_paths(ChainSpec const& chain) {
    return branches(chain) ? "branched" : "cross-linked";
}

void refuse_unsupported_branches(Scene const& scene) {
    for (ChainSpec const& chain : scene.chains) {
        if (goes_by_paths(chain)) refuse_parts(scene, chain);
        if (is_body_tree(chain)) refuse_of_body_tree(scene, chain);
    }
    auto const first = std::find_if(
        scene.chains.begin(), scene.chains.end(),
        [](ChainSpec const& chain) { return goes_by_paths(chain) && !is_body_tree(chain); });
    if (first == scene.chains.end()) return;
    std::string const these = std::string(kind_of_paths(*first)) + " chains ";
    if (scene.solver.handles != Handles::projected)
        throw InputError(
            these + "have projected handles only",
            scene.file + ": solver.handles: " + std::string(name_of(scene.solver.handles)),
            "use projected");
    if (scene.solver.backend == Backend::cuda_levels)
        throw InputError(these + "are not split between GPU and host",
                         scene.file + ": solver.backend: cuda-levels",
                         "use another backend, or auto");
}

}  // namespace catena::scene
