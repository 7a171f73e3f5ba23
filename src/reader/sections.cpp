// Implements the readers of box, dynamics, forces, solver and output.
#include "reader/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "keys/maps.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"
#include "scene/force_changes.hpp"
#include "structure/calvados_rna.hpp"
#include "terms/force_terms.hpp"

namespace catena::scene {

namespace {

/// Applies `read` to the value of `key` if the key is present.
template <class Value, class Read>
void take(Fields const& fields, char const* key, Value& value, Read read) {
    if (Node const* const node = fields.find(key)) value = static_cast<Value>(read(*node));
}

/// Returns the resolved path; throws InputError unless it is a regular file.
std::string existing_file(Node const& node, std::string const& scene_file) {
    std::string const path = resolved(text(node), scene_file);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        fail(node, "no such file: `" + shown_path(path) + "`", "check the path");
    return path;
}

/// Reads `map`: chain name to first and last particle, from 0.
void read_map(Node const& node, OpenMmSpec& spec) {
    if (node.kind != Node::Kind::map)
        fail(node, describe(node) + " is not a map",
             "give chain: [first, last] with particles counted from 0");
    for (Node const& item : node.items) {
        std::string const remedy = "give [first, last] with particles counted from 0";
        if (item.kind != Node::Kind::list || item.items.size() != 2)
            fail(item, describe(item) + " is not a pair of particles", remedy);
        std::int64_t const first = whole(item.items[0], 0), last = whole(item.items[1], 0);
        if (last < first)
            fail(item, fmt::format("the last particle {} comes before the first {}", last, first),
                 remedy);
        spec.map.push_back({item.key, {first, last}});
    }
}

/// Reads `links`: name or kind of a force to the length of the links that replace its bonds.
void read_links(Node const& node, ForceChanges& changes) {
    if (node.kind != Node::Kind::map)
        fail(node, describe(node) + " is not a map",
             "give force: length, as in links: {CustomBondForce: 0.97}");
    for (Node const& item : node.items) changes.links.emplace_back(item.key, positive(item));
}

/// Reads `leave_out`, `links` and `extra`.
ForceChanges read_changes(Fields const& fields, std::string const& file) {
    ForceChanges changes;
    if (Node const* const left = fields.find("leave_out"))
        for (Node const& name : list(*left).items) changes.leave_out.push_back(text(name));
    if (Node const* const links = fields.find("links")) read_links(*links, changes);
    if (Node const* const extra = fields.find("extra"))
        for (Node const& force : list(*extra).items)
            changes.extra.push_back(existing_file(force, file));
    return changes;
}

/// Reads the keys that define the force model: a builder, or a System with topology or map.
void read_model(Fields const& fields, OpenMmSpec& spec, std::string const& file) {
    Node const* const builder = fields.find("builder");
    Node const* const system = fields.find("system");
    Node const* const topology = fields.find("topology");
    Node const* const map = fields.find("map");
    if (builder && system) fail(*builder, "both `builder` and `system`", "keep one of them");
    if (!builder && !system)
        fail(fields.node(), "neither `builder` nor `system`",
             "add `builder: calvados2`, or `system: system.xml`");
    if (builder) {
        if (builder->kind == Node::Kind::scalar && builder->text == calvados_rna::model)
            fail(*builder, fmt::format("`{}` is a model of chains, not a builder", builder->text),
                 "write `builder: calvados2`, which has the forces of RNA, too");
        choice<int>(*builder, {{"calvados2", 2}, {"calvados3", 3}});
        spec.builder = builder->text;
        for (Node const* const extra : {topology, map, fields.find("force_groups"),
                                        fields.find("leave_out"), fields.find("links")})
            if (extra)
                fail(*extra, fmt::format("key `{}` does not apply to a builder", extra->key),
                     "leave it out or give `system`");
        return;
    }
    for (char const* const key : {"ionic_strength", "ph", "switch_width", "charge_termini"})
        if (Node const* const extra = fields.find(key))
            fail(*extra, fmt::format("key `{}` does not apply to a serialised System", key),
                 "leave it out: the System defines it");
    spec.system = existing_file(*system, file);
    if (topology) spec.topology = existing_file(*topology, file);
    if (map) read_map(*map, spec);
    if (!topology && !map)
        fail(fields.node(), "the particles are not assigned to chains",
             "add `topology: topology.pdb`, or `map: {chain: [first, last]}` with particles "
             "counted from 0");
}

/// Largest pH of a scale that begins at 0.
constexpr double largest_ph = 14;

double read_ph(Node const& node) {
    double const ph = number(node);
    if (!(ph >= 0 && ph <= largest_ph))
        fail(node, fmt::format("a pH of {:.6g}", ph), "give a number from 0 to 14");
    return ph;
}

/// Reads `forces.openmm`.
OpenMmSpec read_openmm(Node const& node, Node const* dynamics, bool si, std::string const& file) {
    if (Node const* const table = node.find("residues"))
        fail(*table, "residue tables belong to the chains",
             "write `model: {residues: FILE.csv}` in the chain");
    Fields const fields(node, keys::openmm);
    if (si)
        fail(node, "OpenMM's forces in SI units",
             "write `units: md`: OpenMM uses nm, ps, amu and kJ/mol only");
    OpenMmSpec spec;
    read_model(fields, spec, file);
    // The force field has the run's temperature unless it has its own.
    if (Node const* const run = dynamics ? dynamics->find("temperature") : nullptr)
        spec.temperature = number(*run);
    take(fields, "temperature", spec.temperature, positive);
    if (!(spec.temperature > 0))
        fail(node, "the force field's temperature is that of the run, 0",
             "add `temperature: 300` here");
    take(fields, "ionic_strength", spec.ionic_strength, non_negative);
    if (Node const* const ph = fields.find("ph")) spec.ph = read_ph(*ph);
    take(fields, "switch_width", spec.switch_width, non_negative);
    if (Node const* const termini = fields.find("charge_termini"))
        spec.map.push_back({"", as_numbers(read_charged_termini(*termini))});
    take(fields, "platform", spec.platform, text);
    take(fields, "precision", spec.precision, [](Node const& n) {
        return choice<std::string>(
            n, {{"single", "single"}, {"mixed", "mixed"}, {"double", "double"}});
    });
    take(fields, "threads", spec.threads, [](Node const& n) { return whole(n, 0, 4096); });
    take(fields, "device", spec.device, [](Node const& n) { return whole(n, 0, 4096); });
    take(fields, "path", spec.path, [](Node const& n) {
        return choice<std::string>(
            n, {{"auto", "auto"}, {"device", "device"}, {"host", "host"}, {"inline", "inline"}});
    });
    take(fields, "overlap", spec.overlap, truth);
    take(fields, "layers", spec.layers, [](Node const& n) {
        return choice<std::string>(n, {{"auto", "auto"}, {"all", "all"}, {"none", "none"}});
    });
    take(fields, "split", spec.split, [](Node const& n) {
        return choice<std::string>(n, {{"auto", "auto"}, {"ghosts", "ghosts"}, {"pairs", "pairs"}});
    });
    take(fields, "replicate", spec.replicate, truth);
    take(fields, "audit", spec.audit, truth);
    if (Node const* const groups = fields.find("force_groups"))
        for (Node const& group : list(*groups).items)
            spec.force_groups.push_back(static_cast<int>(whole(group, 0, 31)));
    add_changes(read_changes(fields, file), spec);
    return spec;
}

/// True for `auto`, `all`, or one or two counts separated by a comma; a count is a number or `all`.
bool is_level_count(std::string const& text) {
    if (text == "auto") return true;
    std::size_t const comma = text.find(',');
    auto const one = [](std::string const& part) {
        return part == "all" || (!part.empty() && part.size() < 4 &&
                                 std::all_of(part.begin(), part.end(),
                                             [](unsigned char c) { return c >= '0' && c <= '9'; }));
    };
    return one(text.substr(0, comma)) &&
           (comma == std::string::npos || one(text.substr(comma + 1)));
}

/// Range of box edges; beyond it a double does not resolve places in the box.
double constexpr shortest_edge = 1e-30, longest_edge = 1e9;

}  // namespace

Concentration read_cubic(Node const& cubic) {
    return read_concentration(
        Fields(cubic, keys::cubic).need("concentration", "concentration: 5 mg/ml"));
}

std::optional<Vec3> read_box(Node const& box) {
    if (box.kind == Node::Kind::scalar && box.text == "none") return std::nullopt;
    if (box.kind != Node::Kind::map)
        fail(box, describe(box) + " is not a box", "give `{periodic: [60, 60, 60]}` or `none`");
    Fields const fields(box, keys::box);
    if (Node const* const cubic = fields.find("cubic")) {
        read_cubic(*cubic);
        for (char const* const key : {"periodic", "fill"})
            if (Node const* const other = fields.find(key))
                fail(*other, fmt::format("both `cubic` and `{}`", key),
                     "keep `cubic`, or give all edges by `periodic`");
        return std::nullopt;  // the edges follow from the chains
    }
    Node const& edges = fields.need("periodic", "periodic: [60, 60, 60]");
    Vec3 const lengths = vector3(edges);
    for (double const length : lengths.data) {
        if (!(length > 0))
            fail(edges, fmt::format("box edge {} is not positive", length),
                 "give three edges above 0");
        if (length < shortest_edge || length > longest_edge)
            fail(edges, fmt::format("box edge {} is beyond the range of positions", length),
                 fmt::format("give edges from {:g} to {:g}", shortest_edge, longest_edge));
    }
    return lengths;
}

namespace {

/// Reads the tolerance of adaptive steps. The least value is 1e-13: a solution rounds at 16 eps
/// times the depth of its tree (ChainSystem::residual_bound), which no shorter step reduces.
double read_tolerance(Node const& node, Integrator integrator) {
    double constexpr least = 1e-13, most = 0.1;
    double const tolerance = positive(node);
    if (!is_adaptive(integrator))
        fail(node,
             fmt::format("integrator {} has no error estimate: its steps have the length `step`",
                         name_of(integrator)),
             "leave it out, or use `integrator: dormand-prince` (joint coordinates)");
    if (tolerance < least)
        fail(node,
             fmt::format("tolerance {} is below the resolution of double precision", tolerance),
             "give 1e-13 or more");
    if (tolerance > most)
        fail(node, fmt::format("tolerance {} is too large to bound the error", tolerance),
             "give 0.1 or less, such as 1e-8");
    return tolerance;
}

}  // namespace

calvados2::ChargedTermini read_charged_termini(Node const& node) {
    return choice<calvados2::ChargedTermini>(node, {{"both", {true, true}},
                                                    {"N", {true, false}},
                                                    {"C", {false, true}},
                                                    {"none", {false, false}}});
}

// `implicit-midpoint` is a documented name that this version refuses.
DynamicsSpec read_dynamics(Node const& node, bool si) {
    Fields const fields(node, keys::dynamics);
    DynamicsSpec dynamics;
    dynamics.given = true;
    std::vector<std::pair<std::string_view, Integrator>> names;
    for (IntegratorTraits const& row : integrators) names.emplace_back(row.name, row.kind);
    dynamics.integrator = choice<Integrator>(fields.need("integrator", "integrator: g-baoab"),
                                             names, {"implicit-midpoint"});
    dynamics.step = positive(fields.need("step", "step: 0.01"));
    take(fields, "steps", dynamics.steps, [](Node const& n) { return whole(n, 0); });
    dynamics.has_steps = fields.find("steps") != nullptr;
    take(fields, "temperature", dynamics.temperature, non_negative);
    take(fields, "friction", dynamics.friction, non_negative);
    take(fields, "seed", dynamics.seed, seed64);
    take(fields, "constraint_tolerance", dynamics.constraint_tolerance, positive);
    if (Node const* const tolerance = fields.find("tolerance"))
        dynamics.tolerance = read_tolerance(*tolerance, dynamics.integrator);
    take(fields, "fixman", dynamics.fixman, truth);
    // The default friction is in 1/ps, which has no meaning in SI units.
    if (si && is_langevin(dynamics.integrator)) fields.need("friction", "friction: 1e10");
    return dynamics;
}

ForceSpec read_forces(Node const& node, Node const* dynamics, bool si, std::string const& file) {
    Fields const fields(node, keys::forces);
    ForceSpec forces;
    terms::read(fields, forces);
    if (Node const* const openmm = fields.find("openmm"))
        forces.openmm = read_openmm(*openmm, dynamics, si, file);
    return forces;
}

SolverSpec read_solver(Node const& node) {
    Fields const fields(node, keys::solver);
    SolverSpec solver;
    take(fields, "backend", solver.backend, [](Node const& n) {
        return choice<Backend>(n, {{"auto", Backend::automatic},
                                   {"serial", Backend::serial},
                                   {"segments", Backend::segments},
                                   {"openmp", Backend::openmp},
                                   {"cuda", Backend::cuda},
                                   {"cuda-levels", Backend::cuda_levels}});
    });
    take(fields, "handles", solver.handles, [](Node const& n) {
        return choice<Handles>(n, {{"projected", Handles::projected},
                                   {"full", Handles::full},
                                   {"articulated", Handles::articulated}});
    });
    take(fields, "threads", solver.threads, [](Node const& n) { return whole(n, 0, 4096); });
    take(fields, "refine", solver.refine,
         [](Node const& n) { return static_cast<int>(whole(n, 0, 10)); });
    take(fields, "simd", solver.simd, [](Node const& n) {
        return choice<std::optional<SimdLevel>>(n, {{"auto", std::nullopt},
                                                    {"off", SimdLevel::off},
                                                    {"avx2", SimdLevel::avx2},
                                                    {"avx512", SimdLevel::avx512}});
    });
    take(fields, "balance", solver.balance, truth);
    take(fields, "gpu_levels", solver.gpu_levels, [](Node const& n) {
        if (!is_level_count(text(n)))
            fail(n, describe(n) + " is not a number of levels",
                 "give `auto`, `all`, a number, or two as `UP,DOWN`");
        return n.text;
    });
    return solver;
}

// Observables are compared with the known columns; the others have simple ranges.
OutputSpec read_output(Node const& node) {
    Fields const fields(node, keys::output);
    OutputSpec output;
    take(fields, "every", output.every, [](Node const& n) { return whole(n, 1); });
    take(fields, "checkpoint_every", output.checkpoint_every,
         [](Node const& n) { return whole(n, 0); });
    take(fields, "checkpoint_minutes", output.checkpoint_minutes, non_negative);
    take(fields, "joint_forces", output.joint_forces, truth);
    take(fields, "velocities", output.velocities, truth);
    take(fields, "coordinates", output.coordinates, truth);
    Node const* const observables = fields.find("observables");
    if (!observables) return output;
    static constexpr std::string_view known[] = {"energy",
                                                 "temperature",
                                                 "constraint_error",
                                                 "radius_of_gyration",
                                                 "unweighted_radius_of_gyration",
                                                 "end_to_end_distance"};
    for (Node const& item : list(*observables).items) {
        std::string const name = text(item);
        if (std::find(std::begin(known), std::end(known), name) == std::end(known)) {
            auto const near = nearest(name, known);
            fail(item, describe(item) + " is not an observable",
                 near ? "did you mean `" + *near + "`?" : "use one of " + joined(known));
        }
        if (std::count(output.observables.begin(), output.observables.end(), name))
            fail(item, describe(item) + " is listed twice", "list it once");
        output.observables.push_back(name);
    }
    return output;
}

}  // namespace catena::scene
