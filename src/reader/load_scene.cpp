// Implements the order in which a scene is read. Overrides are applied to the tree first. The
// sections follow, because chains depend on units, box, forces and dynamics. The chains are then
// read as drafts and checked together. A box may follow from them. Movable drafts receive their
// places last, and the fingerprint covers the result.
#include "reader/load_scene.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "error.hpp"
#include "io/memory_limit.hpp"
#include "io/printable.hpp"
#include "keys/maps.hpp"
#include "place/concentration.hpp"
#include "place/filling.hpp"
#include "place/placement.hpp"
#include "place/regions.hpp"
#include "place/start_frame.hpp"
#include "reader/chains.hpp"
#include "reader/force_notes.hpp"
#include "reader/imported.hpp"
#include "reader/overrides.hpp"
#include "reader/replicas.hpp"
#include "reader/sections.hpp"
#include "reader/structure_entry.hpp"
#include "reader/system_links.hpp"
#include "reader/validation.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"
#include "scene/integrator.hpp"
#include "scene/node.hpp"
#include "terms/hash.hpp"

namespace catena {

namespace {

using scene::Fields;
using scene::Node;

/// Notes friction that the integrator ignores, or that lets no velocity outlast a step.
void note_friction(Node const& dynamics, Scene& scene) {
    DynamicsSpec const& d = scene.dynamics;
    if (is_langevin(d.integrator) && !scene.si && d.friction * d.step >= 1)
        scene.note(fmt::format(
            "dynamics.friction is a rate, {0:.6g}/ps: velocities are forgotten within a step. If "
            "{0:.6g} ps is a damping time, write {1:.6g}.",
            d.friction, 1 / d.friction));
    if (is_langevin(d.integrator) || !dynamics.find("friction") || d.friction == 0) return;
    scene.note(fmt::format(
        "dynamics.friction = {:g} has no effect: integrator {} has no thermostat, {} has one",
        d.friction, name_of(d.integrator),
        uses_joint_coordinates(d.integrator) ? "baoab" : "g-baoab"));
}

/// Reads all sections except the chains.
Scene read_frame(Fields const& fields, std::string const& name) {
    Scene made;
    made.file = name;
    Node const* const title = fields.find("title");
    made.title = title ? scene::text(*title) : std::filesystem::path(name).stem().string();
    if (std::string const safe = printable(made.title); safe != made.title) {
        made.title = safe;
        made.note(
            "title: bytes that are not UTF-8 are shown as U+FFFD, control characters as `?`: save "
            "the scene as UTF-8");
    }
    if (Node const* const units = fields.find("units"))
        made.si = scene::choice<bool>(*units, {{"md", false}, {"si", true}});
    Node const* const dynamics = fields.find("dynamics");
    if (dynamics) {
        made.dynamics = scene::read_dynamics(*dynamics, made.si);
        note_friction(*dynamics, made);
    }
    if (Node const* const box = fields.find("box")) made.box = scene::read_box(*box);
    if (Node const* const relax = fields.find("relax")) made.relax = scene::truth(*relax);
    if (Node const* const forces = fields.find("forces"))
        made.forces = scene::read_forces(*forces, dynamics, made.si, name);
    if (Node const* const solver = fields.find("solver")) made.solver = scene::read_solver(*solver);
    if (Node const* const output = fields.find("output")) made.output = scene::read_output(*output);
    scene::note_forces(made);
    return made;
}

/// True if chains whose velocities are not given start thermal. A temperature that is only the
/// default does not make them so, except under g-BAOAB.
bool is_warm(Fields const& fields, Scene const& frame) {
    Node const* const dynamics = fields.find("dynamics");
    return dynamics && frame.dynamics.temperature > 0 &&
           (dynamics->find("temperature") || (is_langevin(frame.dynamics.integrator) &&
                                              !uses_joint_coordinates(frame.dynamics.integrator)));
}

/// Reads the chains of the System that the scene names, and its box unless the scene has one.
std::vector<scene::Draft> import_chains(Fields const& fields, Scene& frame, bool warm) {
    bool const has_box = frame.box.has_value();
    auto drafts = scene::import_chains(*fields.find("forces")->find("openmm"), frame, warm);
    // Only a System whose forces are periodic gives the scene a box.
    if (!has_box && frame.box) scene::refuse_periodic_system(fields, true, frame);
    return drafts;
}

/// Reads the chains of the scene or, if it has none, those of the System that it names.
std::vector<scene::Draft> read_chains(Fields const& fields, Scene& frame) {
    bool const warm = is_warm(fields, frame);
    if (!fields.find("chains") && frame.forces.openmm && !frame.forces.openmm->system.empty())
        return import_chains(fields, frame, warm);
    Node const& chains =
        fields.need("chains", "chains: [{name: a, sequence: GGG, model: calvados2}]");
    std::optional<scene::WrittenSystem> system;
    if (frame.forces.openmm && !frame.forces.openmm->system.empty()) system.emplace(frame);
    if (scene::list(chains).items.empty())
        scene::fail(chains, "the list of chains is empty", "describe at least one chain");
    scene::ChainContext const context{warm, fields.find("start") != nullptr,
                                      system ? &*system : nullptr};
    std::vector<scene::Draft> drafts;
    for (std::size_t i = 0; i < chains.items.size(); ++i)
        scene::read_chain(chains.items[i], i, frame, context, drafts);
    // Soft bonds are judged when all chains are known, for one note on all of them.
    if (system) system->judge(drafts, frame);
    if (system && system->is_periodic()) scene::refuse_periodic_system(fields, false, frame);
    return drafts;
}

/// The box's `cubic`, or nullptr.
Node const* cubic_of(Fields const& fields) {
    Node const* const box = fields.find("box");
    return box && box->kind == Node::Kind::map ? box->find("cubic") : nullptr;
}

/// Edges of a cube from a concentration, nm.
constexpr double shortest_cube = 0.1, longest_cube = 1e9;

/// Sets the edges of a cubic box from the chains' masses and numbers.
void set_cube(Node const& cubic, std::vector<scene::Draft> const& drafts, Scene& frame) {
    if (frame.si)
        scene::fail(cubic, "a concentration in SI units", "write `units: md`, or `periodic`");
    if (frame.forces.openmm && !frame.forces.openmm->system.empty())
        scene::fail(cubic, "a box from a concentration for a System, which has its own box",
                    "give the System's edges by `periodic`");
    Vec3 const box = scene::cube_for(scene::read_cubic(cubic), drafts);
    if (!(box[0] >= shortest_cube && box[0] <= longest_cube))
        scene::fail(cubic, fmt::format("the concentration gives edges of {:.4g} nm", box[0]),
                    "correct the number or the unit");
    frame.box = box;
}

/// Places all chains: at a frame of another run, in the regions of `place`, in that of `fill`, or
/// in the whole box.
void give_places(Fields const& fields, std::vector<scene::Draft>& drafts, Scene& frame) {
    Node const* const box = fields.find("box");
    std::optional<Vec3> const fill = box ? scene::read_fill(*box) : std::nullopt;
    Node const* const start = fields.find("start");
    Node const* const place = scene::first_place(drafts);
    if (start && (place || fill))
        scene::fail(*start, fmt::format("both `start` and `{}`", place ? "place" : "fill"),
                    "keep one of them");
    if (place && fill) scene::fail(*box->find("fill"), "both `place` and `fill`", "keep `place`");
    if (start) return scene::start_from_frame(drafts, frame, *start, is_warm(fields, frame));
    if (place && frame.si) scene::fail(*place, "`place` in SI units", "write `units: md`");
    auto const note = [&](std::string text) {
        if (!text.empty()) frame.note(std::move(text));
    };
    double const least = frame.si ? 0 : scene::excluded_distance;
    std::uint64_t const seed = frame.dynamics.seed;
    if (place)
        scene::place_in_regions(drafts, frame.box, seed);
    else if (fill)
        note(scene::fill_region(drafts, *frame.box, *fill, *box->find("fill"), seed, least));
    else
        note(scene::give_places(drafts, frame.box, seed, least));
}

/// Reads and places the chains of one replica.
std::vector<ChainSpec> one_replica(Fields const& fields, Scene& made) {
    // Positions that those of a frame replace need not fit the links.
    bool const relax = std::exchange(made.relax, made.relax || fields.find("start"));
    std::vector<scene::Draft> drafts = read_chains(fields, made);
    made.relax = relax;
    if (Node const* const cubic = cubic_of(fields)) set_cube(*cubic, drafts, made);
    scene::check_together(fields.node(), made, drafts);
    give_places(fields, drafts, made);
    std::vector<ChainSpec> chains;
    chains.reserve(drafts.size());
    for (scene::Draft& draft : drafts) chains.push_back(std::move(draft.chain));
    return chains;
}

}  // namespace

std::vector<PredictedChain> load_predictions(std::string const& file,
                                             std::vector<std::string> const& overrides) {
    Node at;  // the file itself
    at.text = file;
    std::unique_ptr<Node> const root = scene::parse_document(scene::read_text_file(file, at), file);
    for (std::string const& change : overrides) scene::apply_override(*root, change);
    Fields const fields(*root, scene::keys::top);
    Scene frame = read_frame(fields, file);
    Node const* const chains = fields.find("chains");
    std::vector<PredictedChain> made;
    for (std::size_t i = 0; chains && i < scene::list(*chains).items.size(); ++i) {
        Node const& entry = chains->items[i];
        scene::ChainRequest request{Fields(entry, scene::keys::chain), entry, i, frame};
        Node const* const pdb = request.fields.find("pdb");
        auto const found = pdb ? scene::read_prediction(request, *pdb) : nullptr;
        if (found) made.push_back({request.name(), found});
    }
    return made;
}

Scene load_scene(std::string const& file, std::vector<std::string> const& overrides,
                 LookAtOne const& before_replicas) {
    Node at;  // the file itself
    at.text = file;
    return parse_scene(scene::read_text_file(file, at), file, overrides, before_replicas);
}

// Memory may run out anywhere below; the error becomes a message on the scene.
Scene parse_scene(std::string const& text, std::string const& name,
                  std::vector<std::string> const& overrides, LookAtOne const& before_replicas) try {
    std::unique_ptr<Node> const root = scene::parse_document(text, name);
    for (std::string const& change : overrides) scene::apply_override(*root, change);
    Fields const fields(*root, scene::keys::top);
    Scene const frame = read_frame(fields, name);
    Scene made = frame;
    made.replicas = scene::read_replicas(fields, frame);
    made.chains = one_replica(fields, made);
    if (made.replicas > 1) {
        if (before_replicas) before_replicas(made);
        scene::add_replicas(made, fields, [&](std::uint64_t seed) {
            Scene other = frame;
            other.dynamics.seed = seed;
            return one_replica(fields, other);
        });
    }
    scene::note_missing_forces(made);
    scene::note_step(made);
    scene::note_water(made);
    scene::note_long_screening(made);
    made.hash = scene::fingerprint(made);
    return made;
} catch (std::bad_alloc const&) {
    throw InputError("the scene does not fit into memory", name,
                     is_limited_by_ulimit() ? "raise `ulimit -v`, or make fewer bodies or copies"
                                            : "make fewer bodies or copies");
}

}  // namespace catena
