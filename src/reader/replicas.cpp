// Implements the replicas of a scene.
#include "reader/replicas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "generate/outline.hpp"
#include "io/memory_limit.hpp"
#include "keys/maps.hpp"
#include "math/cubic_lattice.hpp"
#include "place/chain_motion.hpp"
#include "reader/chain_request.hpp"
#include "terms/hash.hpp"

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

/// What to do in place of replicas of a System whose forces are periodic.
constexpr char const* no_replicas_of_periodic_system =
    "leave `replicas` out and run the scene with several seeds, or write the chains with "
    "`builder: calvados2` and `box: none`";

/// True if the forces are those of a System.
bool has_system(Scene const& scene) {
    return scene.forces.openmm && !scene.forces.openmm->system.empty();
}

/// True if two runs of the same start differ: by noise or by thermal velocities.
bool has_chance(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    bool const noise = is_langevin(d.integrator) && d.friction > 0;
    return d.temperature > 0 &&
           (noise ||
            std::any_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
                return chain.velocities == StartVelocities::thermal;
            }));
}

/// True if chains of two replicas are the same, starts included.
bool are_alike(std::vector<ChainSpec> const& first, std::vector<ChainSpec> const& second) {
    ChainPrints const a = prints_of(first), b = prints_of(second);
    return a.kind == b.kind && a.loads == b.loads && a.positions == b.positions &&
           a.velocities == b.velocities;
}

/// Notes generators with a seed of their own, which give all replicas one start.
void note_own_seeds(Fields const& top, Scene& scene) {
    Node const* const chains = top.find("chains");
    if (!chains) return;
    for (std::size_t i = 0; i < chains->items.size(); ++i) {
        Node const* const generator = chains->items[i].find("generator");
        bool const is_map = generator && generator->kind == Node::Kind::map;
        if (!is_map || generator->items.empty() || !generator->items[0].find("seed")) continue;
        scene.note(fmt::format(
            "the generator of chain `{}` has a `seed` of its own: all {} replicas of it start "
            "alike; without it each starts otherwise.",
            shown(ChainRequest{Fields(chains->items[i], keys::chain), chains->items[i], i, scene}
                      .name()),
            scene.replicas));
    }
}

/// Notes chains of which each replica has other bodies, links or branches.
void note_other_bodies(Scene& scene, std::vector<ChainSpec> const& first,
                       std::vector<ChainSpec> const& second) {
    std::string name;
    std::size_t others = 0;
    for (std::size_t c = 0; c < first.size(); ++c) {
        std::span<ChainSpec const> const one(&first[c], 1), other(&second[c], 1);
        if (prints_of(one).kind == prints_of(other).kind) continue;
        if (name.empty())
            name = first[c].name;
        else
            ++others;
    }
    if (name.empty()) return;
    scene.note(fmt::format(
        "each replica draws chain `{}`{} anew, with other bodies, links or branches: means are "
        "over "
        "different chains; a `seed` in the generator gives all replicas one chain and one start.",
        shown(name), others > 0 ? fmt::format(" and {} more", others) : ""));
}

/// Notes replicas that move alike, are of different chains, or start alike by their own seeds.
void note_likeness(Fields const& top, Scene& scene, std::vector<ChainSpec> const& first,
                   std::vector<ChainSpec> const& second, bool differ) {
    note_own_seeds(top, scene);
    if (differ) return note_other_bodies(scene, first, second);
    if (scene.dynamics.given && !has_chance(scene))
        scene.note(fmt::format(
            "all {} replicas move alike: their starts are the same, and the dynamics ({}) have "
            "neither noise nor thermal velocities: leave `replicas` out, or give the chains "
            "random starts or thermal velocities.",
            scene.replicas, name_of(scene.dynamics.integrator)));
}

}  // namespace

void refuse_periodic_system(Fields const& top, bool is_imported, Scene const& scene) {
    Node const* const box = top.find("box");
    if (is_imported && box && box->kind == Node::Kind::scalar)
        fail(*box, "`box: none` for a System whose forces are periodic",
             "leave it out: the box is the System's; for chains without a box write them with "
             "`builder: calvados2`");
    if (scene.replicas > 1)
        fail(*top.find("replicas"), "replicas of a System whose forces are periodic",
             no_replicas_of_periodic_system);
}

std::int64_t read_replicas(Fields const& top, Scene const& frame) {
    Node const* const at = top.find("replicas");
    std::int64_t const replicas = at ? whole(*at, 1, most_replicas) : 1;
    if (replicas == 1) return 1;
    if (Node const* const box = top.find("box"); box && !(box->kind == Node::Kind::scalar))
        fail(*box, "replicas in a periodic box",
             has_system(frame) ? "write `box: none` if no force of the System is periodic, else "
                                 "leave `replicas` out and run the scene with several seeds"
                               : "write `box: none`, since replicas never meet, or leave "
                                 "`replicas` out and run the scene with several seeds");
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

void add_replicas(Scene& scene, Fields const& top,
                  std::function<std::vector<ChainSpec>(std::uint64_t seed)> const& make) {
    refuse_too_many(scene, *top.find("replicas"));
    std::vector<ChainSpec> const first = scene.chains;
    std::vector<ChainSpec> second = make(scene.dynamics.seed + 1);
    bool const differ = !are_alike(first, second);
    note_likeness(top, scene, first, second, differ);
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
