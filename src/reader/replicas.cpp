// Implements the replicas of a scene.
#include "reader/replicas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "generate/outline.hpp"
#include "io/memory_limit.hpp"
#include "math/cubic_lattice.hpp"
#include "place/chain_motion.hpp"
#include "scene/hash.hpp"

namespace catena::scene {
namespace {

constexpr std::int64_t most_replicas = 1'000'000;
/// Free space between replicas at the start, as a part of their width. With `units: md` it is
/// `apart` wider (nm), so that no beads of two replicas seem to touch.
constexpr double free_space = 0.5, apart = 2;

/// Width of the chains along the axis along which it is largest.
double width_of(std::vector<ChainSpec> const& chains) {
    double constexpr none = std::numeric_limits<double>::infinity();
    Vec3 low{{none, none, none}}, high{{-none, -none, -none}};
    for (ChainSpec const& chain : chains)
        for (Vec3 const& x : outline_of(chain).points)
            for (int c = 0; c < 3; ++c)
                low[c] = std::min(low[c], x[c]), high[c] = std::max(high[c], x[c]);
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

/// Throws InputError if the chains of all replicas need more memory than there is.
void refuse_too_many(Scene const& scene, Node const& at) {
    double bytes = 0;
    for (ChainSpec const& chain : scene.chains)
        bytes += (chain.is_beads() ? 150.0 : 700.0) * static_cast<double>(chain.size()) + 3000.0;
    bytes *= static_cast<double>(scene.replicas);
    if (bytes > static_cast<double>(memory_limit()))
        fail(at,
             fmt::format("{} replicas need about {:.3g} GB of memory, and only {}", scene.replicas,
                         bytes * 1e-9, available_memory()),
             "make fewer replicas");
}

}  // namespace

std::int64_t read_replicas(Fields const& top, Scene const& frame) {
    Node const* const at = top.find("replicas");
    std::int64_t const replicas = at ? whole(*at, 1, most_replicas) : 1;
    if (replicas == 1) return 1;
    if (Node const* const box = top.find("box"); box && !(box->kind == Node::Kind::scalar))
        fail(*box, "replicas in a periodic box",
             "write `box: none`, since replicas never meet, or leave `replicas` out and run the "
             "scene with several seeds");
    if (frame.solver.balance)
        fail(*top.find("solver")->find("balance"), "shares by speeds for replicas",
             "leave it out: ranks get equal numbers of replicas");
    Node const* const openmm = frame.forces.openmm ? top.find("forces")->find("openmm") : nullptr;
    for (char const* const key : {"replicate", "split"})
        if (Node const* const way = openmm ? openmm->find(key) : nullptr;
            way && way->text != "false" && way->text != "auto")
            fail(*way, fmt::format("`{}` for replicas", key),
                 "leave it out: ranks get whole replicas and exchange nothing");
    return replicas;
}

void add_replicas(Scene& scene, Node const& at,
                  std::function<std::vector<ChainSpec>(std::uint64_t seed)> const& make) {
    refuse_too_many(scene, at);
    std::vector<ChainSpec> const first = scene.chains;
    std::vector<ChainSpec> second = make(scene.dynamics.seed + 1);
    bool const differ = prints_of(first).positions != prints_of(second).positions;
    std::vector<std::vector<ChainSpec>> all{first, std::move(second)};
    for (std::int64_t r = 2; r < scene.replicas; ++r)
        all.push_back(differ ? make(scene.dynamics.seed + static_cast<std::uint64_t>(r)) : first);
    double width = 0;
    for (auto const& chains : all) width = std::max(width, width_of(chains));
    double const spacing = (1 + free_space) * width + (scene.si ? (width > 0 ? 0 : 1) : apart);
    CubicLattice const lattice(scene.replicas);
    scene.chains.clear();
    for (std::int64_t r = 0; r < scene.replicas; ++r) {
        auto const site = lattice.site(r);
        Vec3 by;
        for (int c = 0; c < 3; ++c)
            by[c] = spacing * static_cast<double>(site[static_cast<std::size_t>(c)]);
        for (ChainSpec& chain : all[static_cast<std::size_t>(r)]) {
            translate(chain, by);
            chain.name += fmt::format("-{}", r + 1);
            scene.chains.push_back(std::move(chain));
        }
    }
}

}  // namespace catena::scene
