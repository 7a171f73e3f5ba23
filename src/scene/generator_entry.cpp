#include "scene/generator_entry.hpp"

#include <fmt/format.h>

#include "scene/generators.hpp"
#include "scene/random.hpp"

namespace catena::scene {

namespace {

Node const& single_entry(Node const& node) {
    Fields const kinds(node, {"random", "pendulum", "freely_jointed"}, {"coil", "dill", "worm_like"});
    if (node.items.size() != 1)
        fail(node, fmt::format("the chain has {} generators", node.items.size()), "give one of `random`, `pendulum`, `freely_jointed`");
    return *kinds.find(node.items[0].key);
}

double positive_or(Fields const& fields, char const* key, double otherwise) {
    Node const* const node = fields.find(key);
    return node ? positive(*node) : otherwise;
}

}  // namespace

GeneratorEntry::GeneratorEntry(ChainRequest const& request, Node const& node) : request_(request), entry_(single_entry(node)) {
    if (entry_.key == "random") {
        Fields const random(entry_, {"bodies", "joint", "seed", "loads"});
        size_ = whole(random.need("bodies", "bodies: 100"), 1);
        joint_ = choice<JointType>(random.need("joint", "joint: revolute"),
                                   {{"link", JointType::link}, {"revolute", JointType::revolute}, {"spherical", JointType::spherical}},
                                   {"planar", "universal", "weld", "prismatic", "helical"});
        beads_ = joint_ == JointType::link;
        if (Node const* const loads = random.find("loads")) loads_ = truth(*loads);
        velocities_ = true;
        request.allow("generator `random`", beads_ ? Names{"anchor"} : Names{});
    } else if (entry_.key == "pendulum") {
        Fields const rods(entry_, {"links", "mass", "length", "radius"});
        size_ = whole(rods.need("links", "links: 8"), 1);
        mass_ = positive_or(rods, "mass", 1), length_ = positive_or(rods, "length", 1),
        radius_ = positive_or(rods, "radius", 0.05 * length_);
        velocities_ = true;
        request.allow("generator `pendulum`", {});
        if (request.base == Base::free)
            fail(request.fields.need("base", "base: fixed"), "a pendulum on a free base", "write `base: fixed`");
    } else {
        Fields const walk(entry_, {"beads", "length", "mass", "seed"});
        size_ = whole(walk.need("beads", "beads: 100"), 1);
        mass_ = positive_or(walk, "mass", 1), length_ = positive(walk.need("length", "length: 1.0"));
        beads_ = true;
        request.allow("generator `freely_jointed`", {"positions", "links", "anchor"});
    }
}

std::uint64_t GeneratorEntry::seed(std::int64_t copy) const {
    // A seed of its own makes the same chain wherever the entry stands in the scene.
    Node const* const own = entry_.find("seed");
    return own ? seed_of_stream(seed64(*own), static_cast<std::uint64_t>(copy)) : request_.seed(copy);
}

void GeneratorEntry::make(ChainSpec& chain, std::int64_t copy) const {
    if (entry_.key == "pendulum") {
        chain.bodies = pendulum(size_, mass_, length_, radius_);
    } else if (entry_.key == "freely_jointed") {
        chain.beads = freely_jointed(size_, length_, mass_, request_.base, request_.anchor(), seed(copy));
        Node const* const positions = request_.fields.find("positions");
        if (positions) request_.place(chain.beads, request_.positions_from(*positions, chain.size()), *positions);
    } else if (beads_) {
        chain.beads = random_beads(size_, request_.base, request_.anchor(), seed(copy));
    } else {
        chain.bodies = random_bodies(size_, joint_, request_.base, seed(copy));
        if (!loads_) chain.bodies.torque.clear(), chain.bodies.wrench.clear();
    }
}

}  // namespace catena::scene
