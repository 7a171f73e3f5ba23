// Implements the fingerprints of scenes, chains and files.
#include "terms/hash.hpp"

#include <fstream>
#include <sstream>

#include "error.hpp"
#include "terms/fingerprint.hpp"
#include "terms/force_terms.hpp"

namespace catena::scene {

std::string content_of(std::string const& path) {
    if (path.empty()) return {};
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream)
        throw InputError("the file cannot be read", path, "check the file and its permissions");
    return text.str();
}

namespace {

void add_carried(Fingerprint& print, CarriedBeads const& c) {
    add_named(print, "carried", c.size() > 0, c.offset, c.position, c.mass, c.residue);
}

void add_tip(Fingerprint& print, TipJoint const& t) {
    print.add_each(t.type, t.axis, t.first_axis, t.pitch, t.rotation, t.translation, t.q);
    print.add_each(t.anchor.has_value(), t.anchor.value_or(Vec3::zero()), t.length);
    add_named(print, "ring", t.ring);
}

/// Adds what the scene says of loops; their frames G follow from the start.
void add_loops(Fingerprint& print, ChainSpec const& chain) {
    for (LoopClosure const& loop : chain.loops) {
        print.add(std::string("loop"));
        print.add_each(loop.inboard, loop.outboard);
        add_tip(print, loop.joint);
    }
}

void add_driven(Fingerprint& print, std::vector<DrivenJoint> const& driven) {
    for (DrivenJoint const& joint : driven) {
        print.add(std::string("driven"));
        print.add(joint.body);
        for (PrescribedMotion const& c : joint.course)
            print.add_each(c.offset, c.rate, c.amplitude, c.frequency, c.phase);
    }
}

void add_linked(Fingerprint& print, LinkedArrays const& l) {
    add_named(print, "linked", l.size() > 0, l.mass, l.inertia, l.position, l.velocity,
              l.orientation, l.omega, l.inboard, l.outboard, l.length, l.anchor);
    add_carried(print, l.carried);
}

/// Adds ends and lengths of cross-links.
void add_crosslinks(Fingerprint& print, ChainSpec const& chain) {
    std::vector<std::int64_t> ends;
    std::vector<double> lengths;
    for (CrossLink const& link : chain.crosslinks) {
        ends.insert(ends.end(), {link.inboard, link.outboard});
        lengths.push_back(link.length);
    }
    add_named(print, "crosslinks", chain.is_cross_linked(), ends, lengths);
}

void add_term_numbers(Fingerprint& print, ChainSpec const& chain) {
    for (TermNumbers const& each : chain.term_numbers)
        add_named(print, each.term.c_str(), true, each.values);
}

void add_chain(Fingerprint& print, ChainSpec const& chain) {
    print.add_each(chain.name, chain.base, chain.tip, chain.velocities);
    BeadArrays const& beads = chain.beads;
    print.add_each(beads.mass, beads.position, beads.velocity, beads.length, beads.residue,
                   beads.anchor);
    BodyArrays const& b = chain.bodies;
    print.add_each(b.mass, b.com, b.inertia, b.joint, b.axis, b.rotation, b.translation, b.q, b.qd,
                   b.free_base.position, b.free_base.velocity);
    terms::for_each_column([&](auto const& column) {
        if (!column.named) print.add(b.*column.values);
    });
    add_named(print, "first axes", !b.first_axis.empty(), b.first_axis);
    add_named(print, "pitches", !b.pitch.empty(), b.pitch);
    terms::for_each_column([&](auto const& column) {
        if (column.named)
            add_named(print, column.named, !(b.*column.values).empty(), b.*column.values);
    });
    add_driven(print, b.driven);
    add_carried(print, b.carried);
    add_linked(print, chain.linked);
    if (chain.tip == Tip::jointed) add_tip(print, chain.tip_joint);
    add_named(print, "parents", chain.is_branched(), chain.parent);
    add_crosslinks(print, chain);
    add_loops(print, chain);
    add_term_numbers(print, chain);
}

/// Adds what terms say at this place of the fingerprint.
void add_terms(Fingerprint& print, Scene const& scene, terms::PrintPlace place) {
    terms::for_each([&](auto term) {
        if (decltype(term)::print_place == place) decltype(term)::print(scene, print);
    });
}

}  // namespace

std::string fingerprint(Scene const& scene) {
    Fingerprint print;
    print.add(std::string("catena scene 1"));
    print.add_each(scene.si, scene.box.has_value(), scene.box.value_or(Vec3::zero()));
    add_terms(print, scene, terms::PrintPlace::before_chains);
    print.add(scene.chains.size());
    for (ChainSpec const& chain : scene.chains) add_chain(print, chain);
    add_terms(print, scene, terms::PrintPlace::forces);
    DynamicsSpec const& d = scene.dynamics;
    add_terms(print, scene, terms::PrintPlace::before_dynamics);
    print.add_each(d.given, traits_of(d.integrator).code, d.step, d.temperature, d.friction, d.seed,
                   d.constraint_tolerance);
    add_terms(print, scene, terms::PrintPlace::after_dynamics);
    add_named(print, "tolerance", d.tolerance > 0, d.tolerance);
    add_named(print, "relax", scene.relax);
    add_named(print, "replicas", scene.replicas > 1, scene.replicas);
    return print.text();
}

namespace {

/// Adds names, ends, masses, joints and links: what a branch must keep.
void add_kind(Fingerprint& print, ChainSpec const& chain) {
    BodyArrays const& b = chain.bodies;
    LinkedArrays const& l = chain.linked;
    print.add_each(chain.name, chain.base, chain.tip);
    print.add_each(chain.beads.mass, chain.beads.length, chain.beads.residue, chain.beads.anchor);
    print.add_each(b.mass, b.com, b.inertia, b.joint, b.axis, b.rotation, b.translation,
                   b.first_axis, b.pitch);
    print.add_each(l.mass, l.inertia, l.inboard, l.outboard, l.length, l.anchor);
    add_carried(print, chain.carried());
    if (chain.tip == Tip::jointed) add_tip(print, chain.tip_joint);
    add_named(print, "parents", chain.is_branched(), chain.parent);
    add_crosslinks(print, chain);
    add_loops(print, chain);
}

void add_loads(Fingerprint& print, ChainSpec const& chain) {
    terms::for_each_column([&](auto const& column) { print.add(chain.bodies.*column.values); });
    add_driven(print, chain.bodies.driven);
    add_term_numbers(print, chain);
}

void add_positions(Fingerprint& print, ChainSpec const& chain) {
    print.add_each(chain.beads.position, chain.bodies.q, chain.bodies.free_base.position,
                   chain.linked.position, chain.linked.orientation);
}

void add_velocities(Fingerprint& print, ChainSpec const& chain) {
    print.add_each(chain.velocities, chain.beads.velocity, chain.bodies.qd,
                   chain.bodies.free_base.velocity, chain.linked.velocity, chain.linked.omega);
}

}  // namespace

ChainPrints prints_of(std::span<ChainSpec const> chains) {
    Fingerprint kind, loads, positions, velocities;
    for (ChainSpec const& chain : chains) {
        add_kind(kind, chain);
        add_loads(loads, chain);
        add_positions(positions, chain);
        add_velocities(velocities, chain);
    }
    return {kind.short_text(), loads.short_text(), positions.short_text(), velocities.short_text()};
}

std::string content_print(std::string const& path) { return text_print(content_of(path)); }

std::string text_print(std::string const& text) {
    Fingerprint print;
    print.add(text);
    return print.short_text();
}

}  // namespace catena::scene
