#include "scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "scene/chains.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"
#include "scene/filling.hpp"
#include "scene/force_notes.hpp"
#include "scene/hash.hpp"
#include "scene/imported.hpp"
#include "scene/node.hpp"
#include "scene/overrides.hpp"
#include "scene/placement.hpp"
#include "scene/printable.hpp"
#include "scene/sections.hpp"
#include "scene/system_links.hpp"
#include "scene/validation.hpp"

namespace catena {

namespace {

using scene::Fields;
using scene::Node;

/// Everything but the chains.
Scene read_frame(Fields const& fields, std::string const& name) {
    Scene made;
    made.file = name;
    Node const* const title = fields.find("title");
    made.title = title ? scene::text(*title) : std::filesystem::path(name).stem().string();
    if (std::string const safe = printable(made.title); safe != made.title) {
        made.title = safe;
        made.note("title: bytes that are not UTF-8 stand as U+FFFD, control characters as `?`: save the scene as UTF-8");
    }
    if (Node const* const units = fields.find("units")) made.si = scene::choice<bool>(*units, {{"md", false}, {"si", true}});
    Node const* const dynamics = fields.find("dynamics");
    if (dynamics) made.dynamics = scene::read_dynamics(*dynamics, made.si);
    if (Node const* const box = fields.find("box")) made.box = scene::read_box(*box);
    if (Node const* const relax = fields.find("relax")) made.relax = scene::truth(*relax);
    if (Node const* const forces = fields.find("forces")) made.forces = scene::read_forces(*forces, dynamics, made.si, name);
    if (Node const* const solver = fields.find("solver")) made.solver = scene::read_solver(*solver);
    if (Node const* const output = fields.find("output")) made.output = scene::read_output(*output);
    scene::note_forces(made);
    return made;
}

/// Chains of the scene or, where it writes none, of the System it names.
std::vector<scene::Draft> read_chains(Fields const& fields, Scene& frame) {
    Node const* const dynamics = fields.find("dynamics");
    bool const warm =
        dynamics && frame.dynamics.temperature > 0 && (dynamics->find("temperature") || frame.dynamics.integrator >= Integrator::g_baoab);
    if (!fields.find("chains") && frame.forces.openmm && !frame.forces.openmm->system.empty())
        return scene::import_chains(*fields.find("forces")->find("openmm"), frame, warm);
    Node const& chains = fields.need("chains", "chains: [{name: a, sequence: GGG, model: calvados2}]");
    std::optional<scene::WrittenSystem> system;
    if (frame.forces.openmm && !frame.forces.openmm->system.empty()) system.emplace(frame);
    if (scene::list(chains).items.empty()) scene::fail(chains, "the list of chains is empty", "describe at least one chain");
    std::vector<scene::Draft> drafts;
    for (std::size_t i = 0; i < chains.items.size(); ++i)
        scene::read_chain(chains.items[i], i, frame, warm, system ? &*system : nullptr, drafts);
    if (system) system->judge(drafts, frame);
    return drafts;
}

void give_places(Fields const& fields, std::vector<scene::Draft>& drafts, Scene const& frame) {
    Node const* const box = fields.find("box");
    if (std::optional<Vec3> const fill = box ? scene::read_fill(*box) : std::nullopt)
        scene::fill_region(drafts, *frame.box, *fill, *box->find("fill"), frame.dynamics.seed);
    else
        scene::give_places(drafts, frame.box, frame.dynamics.seed);
}

}  // namespace

std::int64_t Scene::bodies() const {
    std::int64_t sum = 0;
    for (ChainSpec const& chain : chains) sum += static_cast<std::int64_t>(chain.size());
    return sum;
}

void Scene::note(std::string text) {
    // What is said again follows soon; a search of all would be quadratic where each of many chains has its own note.
    std::size_t constexpr looked_at = 1000;
    auto const from = notes.end() - static_cast<std::ptrdiff_t>(std::min(notes.size(), looked_at));
    if (std::find(from, notes.end(), text) == notes.end()) notes.push_back(std::move(text));
}

Scene load_scene(std::string const& file, std::vector<std::string> const& overrides) {
    Node at;  // the file itself
    at.text = file;
    return parse_scene(scene::read_text_file(file, at), file, overrides);
}

Scene parse_scene(std::string const& text, std::string const& name, std::vector<std::string> const& overrides) try {
    std::unique_ptr<Node> const root = scene::parse_document(text, name);
    for (std::string const& change : overrides) scene::apply_override(*root, change);
    Fields const fields(*root, {"title", "units", "chains", "box", "forces", "dynamics", "solver", "output", "relax"});
    Scene made = read_frame(fields, name);
    std::vector<scene::Draft> drafts = read_chains(fields, made);
    scene::check_together(*root, made, drafts);
    give_places(fields, drafts, made);
    made.chains.reserve(drafts.size());
    for (scene::Draft& draft : drafts) made.chains.push_back(std::move(draft.chain));
    made.hash = scene::fingerprint(made);
    return made;
} catch (std::bad_alloc const&) {
    throw InputError("the scene does not fit into memory", name, "make fewer bodies or copies");
}

GpuLevels SolverSpec::levels_on_gpu() const {
    auto const number = [](std::string const& part) { return part == "auto" || part == "all" ? GpuLevels::all : std::stoi(part); };
    std::size_t const comma = gpu_levels.find(',');
    return {number(gpu_levels.substr(0, comma)), number(comma == std::string::npos ? gpu_levels : gpu_levels.substr(comma + 1))};
}

char const* name_of(JointType type) {
    switch (type) {
        case JointType::free:
            return "free";
        case JointType::link:
            return "link";
        case JointType::spherical:
            return "spherical";
        case JointType::revolute:
            return "revolute";
        case JointType::universal:
            return "universal";
        case JointType::weld:
            return "weld";
        case JointType::prismatic:
            return "prismatic";
        case JointType::helical:
            return "helical";
    }
    return "?";
}

std::string DynamicsSpec::why_host_alone() const {
    if (fixman) return "the Fixman force is computed on the host";
    if (given && (is_implicit(integrator) || integrator == Integrator::baoab))
        return std::string("integrator ") + name_of(integrator) + " works on the host";
    return "";
}

char const* name_of(Integrator integrator) {
    switch (integrator) {
        case Integrator::rk4:
            return "rk4";
        case Integrator::dormand_prince:
            return "dormand-prince";
        case Integrator::velocity_verlet:
            return "velocity-verlet";
        case Integrator::staggered:
            return "staggered";
        case Integrator::baoab:
            return "baoab";
        case Integrator::implicit_baoab:
            return "implicit-baoab";
        case Integrator::rattle:
            return "rattle";
        case Integrator::g_baoab:
            return "g-baoab";
        case Integrator::implicit_g_baoab:
            return "implicit-g-baoab";
    }
    return "?";
}

char const* name_of(Backend backend) {
    switch (backend) {
        case Backend::automatic:
            return "auto";
        case Backend::serial:
            return "serial";
        case Backend::segments:
            return "segments";
        case Backend::openmp:
            return "openmp";
        case Backend::cuda:
            return "cuda";
        case Backend::cuda_levels:
            return "cuda-levels";
    }
    return "?";
}

char const* name_of(Handles handles) {
    switch (handles) {
        case Handles::projected:
            return "projected";
        case Handles::full:
            return "full";
        case Handles::articulated:
            return "articulated";
    }
    return "?";
}

}  // namespace catena
