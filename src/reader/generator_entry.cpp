// Implements the readers of the parameters of each generator. The names of generators and
// parameters are those in inputs/keys/generators.md.
#include "reader/generator_entry.hpp"

#include <fmt/format.h>

#include "generate/random.hpp"
#include "joints/joint_models.hpp"
#include "keys/maps.hpp"

namespace catena::scene {

namespace {

/// Returns the single generator of the entry; throws InputError for several.
Node const& single_entry(Node const& node) {
    Fields const kinds(node, keys::generator);
    if (node.items.size() != 1)
        fail(node, fmt::format("the chain has {} generators", node.items.size()),
             "give one of `random`, `pendulum`, `coil`, `dill`, `elastic_rod`, `polygon`, "
             "`freely_jointed`, `worm_like`, `star`, `brush`, `dendrimer`, `random_tree`");
    return *kinds.find(node.items[0].key);
}

/// Reads an optional distribution.
void take(Fields const& fields, char const* key, Distribution& value) {
    if (Node const* const node = fields.find(key)) value = read_distribution(*node);
}

/// Reads an optional number.
void take(Fields const& fields, char const* key, double& value) {
    if (Node const* const node = fields.find(key)) value = number(*node);
}

/// Reads the joint type of a random chain.
RandomJoint random_joint(Node const& node) {
    return choice<RandomJoint>(node, {{"link", RandomJoint::link},
                                      {"planar", RandomJoint::planar},
                                      {"revolute", RandomJoint::revolute},
                                      {"universal", RandomJoint::universal},
                                      {"spherical", RandomJoint::spherical},
                                      {"weld", RandomJoint::weld},
                                      {"prismatic", RandomJoint::prismatic},
                                      {"helical", RandomJoint::helical},
                                      {"cylindrical", RandomJoint::cylindrical},
                                      {"planar3", RandomJoint::planar3},
                                      {"mixed", RandomJoint::mixed}});
}

}  // namespace

bool stands_fixed(Node const& generator) {
    return generator.find("pendulum") || generator.find("coil") || generator.find("dill");
}

GeneratorEntry::GeneratorEntry(ChainRequest& request, Node const& node)
    : request_(request), entry_(single_entry(node)) {
    if (entry_.key == "random")
        read_random();
    else if (entry_.key == "freely_jointed" || entry_.key == "worm_like")
        read_walk();
    else if (entry_.key == "polygon")
        read_polygon();
    else if (entry_.key == "elastic_rod")
        read_elastic_rod();
    else if (makes_branches(entry_.key))
        read_branches();
    else
        read_rods();
}

// Random bodies and joints; `rigid` mixes rigid bodies into chains of links.
void GeneratorEntry::read_random() {
    Fields const fields(entry_, keys::random);
    RandomChain& chain = random_.emplace();
    size_ = chain.bodies = whole(fields.need("bodies", "bodies: 100"), 1);
    chain.joint = random_joint(fields.need("joint", "joint: revolute"));
    chain.base = request_.base;
    bool const links = chain.joint == RandomJoint::link;
    request_.allow("generator `random`", links ? Names{"anchor"} : Names{});
    if (links) chain.anchor = request_.anchor();
    take(fields, "mass", chain.mass), take(fields, "length", chain.length),
        take(fields, "inertia", chain.inertia);
    if (Node const* const rigid = fields.find("rigid")) {
        if (!links)
            fail(*rigid, "a fraction of rigid bodies in a chain that has no beads",
                 "leave it out or write `joint: link`");
        chain.rigid = number(*rigid);
        if (!(chain.rigid >= 0 && chain.rigid <= 1))
            fail(*rigid, fmt::format("{} is not a fraction", chain.rigid), "give 0 to 1");
    }
    Node const* const loads = fields.find("loads");
    if (loads) loads_ = truth(*loads);
    beads_ = links && chain.rigid == 0;
    velocities_ = true;
}

// Rods on revolute joints: pendulum, coil and dill.
void GeneratorEntry::read_rods() {
    bool const swinging = entry_.key == "pendulum", dill = entry_.key == "dill";
    char const* const count = swinging ? "links" : "bodies";
    Fields const fields = swinging ? Fields(entry_, keys::pendulum)
                          : dill   ? Fields(entry_, keys::dill)
                                   : Fields(entry_, keys::coil);
    Rods& rods = rods_.emplace();
    size_ = rods.bodies = whole(fields.need(count, std::string(count) + ": 8"), 1);
    take(fields, "mass", rods.mass), take(fields, "length", rods.length);
    if (Node const* const radius = fields.find("radius")) rods.radius = read_distribution(*radius);
    velocities_ = true;
    request_.allow(swinging ? "generator `pendulum`"
                   : dill   ? "generator `dill`"
                            : "generator `coil`",
                   {});
    winding_.base = request_.base;
    if (swinging) {
        if (request_.base == Base::free)
            fail(request_.fields.need("base", "base: fixed"), "a pendulum on a free base",
                 "write `base: fixed`");
        return;
    }
    take(fields, "turn", winding_.turn);
    if (!dill) return take(fields, "twist", winding_.twist);
    Node const* const ratio = fields.find("ratio");
    if (ratio) winding_.ratio = positive(*ratio);
    if (winding_.ratio > 1)
        fail(*ratio, fmt::format("ratio {} is above 1", winding_.ratio),
             "give a number above 0, at most 1");
}

// Random walks of beads; `positions` may replace the walk.
void GeneratorEntry::read_walk() {
    bool const worm = entry_.key == "worm_like";
    char const* const count = worm ? "bodies" : "beads";
    Fields const fields =
        worm ? Fields(entry_, keys::worm_like) : Fields(entry_, keys::freely_jointed);
    Walk& walk = walk_.emplace();
    size_ = walk.beads = whole(fields.need(count, std::string(count) + ": 100"), 1);
    take(fields, "mass", walk.mass);
    walk.length = read_distribution(fields.need("length", "length: 1.0"));
    if (worm) persistence_ = positive(fields.need("persistence", "persistence: 50"));
    walk.base = request_.base;
    beads_ = true;
    request_.allow(worm ? "generator `worm_like`" : "generator `freely_jointed`",
                   {"positions", "links", "anchor"});
    walk.anchor = request_.anchor();
    if (worm && request_.scene.dynamics.given && !request_.scene.forces.openmm)
        request_.scene.note(fmt::format(
            "generator `worm_like` gives the start alone: no force keeps the persistence length of "
            "{:.6g} in a run, and the chain becomes a random walk. Take `elastic_rod`, or angle "
            "forces of an OpenMM System.",
            persistence_));
}

// Stars, brushes, dendrimers and random trees; `positions` may replace their growth.
void GeneratorEntry::read_branches() {
    branched_.emplace(request_, entry_);
    size_ = branched_->size();
    beads_ = true;
}

// Regular polygons, to be closed by a tip.
void GeneratorEntry::read_polygon() {
    Fields const fields(entry_, keys::polygon);
    Polygon& shape = polygon_.emplace();
    size_ = shape.sides = whole(fields.need("bodies", "bodies: 12"), 3);
    shape.joint = choice<JointType>(fields.need("joint", "joint: spherical"),
                                    {{SphericalJoint::name, SphericalJoint::type},
                                     {RevoluteJoint::name, RevoluteJoint::type},
                                     {LinkJoint::name, LinkJoint::type}});
    shape.base = request_.base;
    if (Node const* const mass = fields.find("mass")) shape.mass = positive(*mass);
    if (Node const* const length = fields.find("length")) shape.length = positive(*length);
    Node const *const radius = fields.find("radius"), *const spin = fields.find("spin");
    shape.radius = radius ? positive(*radius) : 0.05 * shape.length;
    if (spin) shape.spin = vector3(*spin);
    beads_ = is_rod(shape.joint);
    velocities_ = !beads_;
    for (Node const* const given : {radius, spin})
        if (given && beads_)
            fail(*given, fmt::format("key `{}` does not apply to a polygon of beads", given->key),
                 "leave it out");
    if (beads_ && shape.base == Base::fixed)
        fail(entry_, "a polygon of beads on a fixed base", "write `base: free`");
    request_.allow("generator `polygon`", {});
}

// Elastic rods in thermal equilibrium; rods longer than ten persistence lengths are refused.
void GeneratorEntry::read_elastic_rod() {
    Fields const fields(entry_, keys::elastic_rod);
    ElasticRod& rod = elastic_.emplace();
    size_ = rod.bodies = whole(fields.need("bodies", "bodies: 100"), 1);
    rod.mass = positive(fields.need("mass", "mass: 6500"));
    rod.length = positive(fields.need("length", "length: 3.4"));
    rod.radius = positive(fields.need("radius", "radius: 1"));
    rod.bend = positive(fields.need("bend", "bend: 50, the persistence length"));
    rod.twist = positive(fields.need("twist", "twist: 100, the persistence length"));
    for (char const* const key : {"bend", "twist"})
        if (double const persistence = key == std::string("bend") ? rod.bend : rod.twist;
            persistence < 0.1 * rod.length)
            fail(*fields.find(key),
                 fmt::format("a persistence length of {:g} for rods of {:g}", persistence,
                             rod.length),
                 "use rods of at most ten times that length, or a freely jointed chain");
    rod.base = request_.base;
    rod.kt = request_.scene.boltzmann() * request_.scene.dynamics.temperature;
    if (!(rod.kt > 0))
        fail(entry_, "an elastic rod without a temperature above 0",
             "add `dynamics: {temperature: 300}`");
    request_.allow("generator `elastic_rod`", {});
    velocities_ = true;
}

std::uint64_t GeneratorEntry::seed(std::int64_t copy) const {
    // The key `seed` of a generator yields the same chain at any position of the entry in the
    // scene.
    Node const* const own = entry_.find("seed");
    return own ? seed_of_stream(seed64(*own), static_cast<std::uint64_t>(copy))
               : request_.seed(copy);
}

void GeneratorEntry::make(ChainSpec& chain, std::int64_t copy) const {
    if (rods_) {
        Rods rods = *rods_;
        rods.seed = seed(copy);
        chain.bodies = entry_.key == "pendulum" ? pendulum(rods)
                       : entry_.key == "coil"   ? coil(rods, winding_)
                                                : dill(rods, winding_);
    } else if (branched_) {
        branched_->make(chain, seed(copy));
    } else if (elastic_) {
        ElasticRod rod = *elastic_;
        rod.seed = seed(copy);
        chain.bodies = elastic_rod(rod);
    } else if (polygon_) {
        if (beads_)
            chain.beads = polygon_of_beads(*polygon_);
        else
            chain.bodies = polygon(*polygon_);
    } else if (walk_) {
        Walk walk = *walk_;
        walk.seed = seed(copy);
        chain.beads = persistence_ > 0 ? worm_like(walk, persistence_) : freely_jointed(walk);
        Node const* const positions = request_.fields.find("positions");
        if (positions)
            request_.place(chain.beads, request_.positions_from(*positions, chain.size()),
                           *positions);
    } else {
        RandomChain random = *random_;
        random.seed = seed(copy);
        if (beads_)
            chain.beads = random_beads(random);
        else if (random.joint == RandomJoint::link)
            chain.linked = random_linked(random);
        else
            chain.bodies = random_bodies(random);
        if (!loads_) chain.bodies.torque.clear(), chain.bodies.wrench.clear();
    }
}

}  // namespace catena::scene
