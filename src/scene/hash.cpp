// Implements the fingerprints of scenes, chains and files.
#include "scene/hash.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <sstream>

#include "error.hpp"
#include "scene/force_changes.hpp"

namespace catena::scene {

namespace {

/// Hash of a sequence of values. Lengths of texts and lists enter too, so that their boundaries
/// count.
class Fingerprint {
  public:
    void word(std::uint64_t value) {
        a_ = std::rotl(a_ ^ value, 27) * 0x9E3779B185EBCA87u + 0x165667B19E3779F9u;
        b_ = (std::rotl(b_, 31) + value) * 0xC2B2AE3D27D4EB4Fu ^ (b_ >> 29);
    }
    void add(double value) { word(std::bit_cast<std::uint64_t>(value)); }
    void add(std::int64_t value) { word(static_cast<std::uint64_t>(value)); }
    void add(std::uint64_t value) { word(value); }
    void add(int value) { word(static_cast<std::uint64_t>(value)); }
    void add(bool value) { word(value ? 1 : 0); }
    void add(std::string const& text) {
        word(text.size());
        for (std::size_t i = 0; i < text.size(); i += 8) {
            std::uint64_t packed = 0;
            for (std::size_t j = i; j < text.size() && j < i + 8; ++j)
                packed |= std::uint64_t{static_cast<unsigned char>(text[j])} << (8 * (j - i));
            word(packed);
        }
    }
    template <class Enum>
        requires std::is_enum_v<Enum>
    void add(Enum value) {
        word(static_cast<std::uint64_t>(value));
    }
    template <std::size_t N>
    void add(std::array<double, N> const& values) {
        for (double const value : values) add(value);
    }
    void add(Vec3 const& v) { add_all(v.data); }
    void add(Mat3 const& m) { add_all(m.data); }
    void add(Sym3 const& m) { add_all(m.data); }
    void add(std::optional<double> const& value) {
        add(value.has_value());
        add(value.value_or(0));
    }
    template <class A, class B>
    void add(std::pair<A, B> const& values) {
        add(values.first);
        add(values.second);
    }
    template <class T>
    void add(std::vector<T> const& values) {
        word(values.size());
        for (T const& value : values) add(value);
    }
    template <class... T>
    void add_each(T const&... values) {
        (add(values), ...);
    }
    std::string short_text() const { return fmt::format("{:016x}", mixed(a_ + b_)); }
    std::string text() const { return fmt::format("{:016x}{:016x}", mixed(a_), mixed(b_)); }

  private:
    template <std::size_t N>
    void add_all(double const (&values)[N]) {
        for (double const value : values) add(value);
    }
    static std::uint64_t mixed(std::uint64_t h) {
        h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
        h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
        return h ^ (h >> 33);
    }
    std::uint64_t a_ = 0x243F6A8885A308D3u, b_ = 0x13198A2E03707344u;  // digits of pi
};

std::string content_of(std::string const& path) {
    if (path.empty()) return {};
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream)
        throw InputError("the file cannot be read", path, "check the file and its permissions");
    return text.str();
}

/// Adds optional parts of a scene under their name, and only if present. Scenes without them keep
/// their fingerprint.
template <class... T>
void add_named(Fingerprint& print, char const* name, bool there, T const&... values) {
    if (!there) return;
    print.add(std::string(name));
    print.add_each(values...);
}

void add_carried(Fingerprint& print, CarriedBeads const& c) {
    add_named(print, "carried", c.size() > 0, c.offset, c.position, c.mass, c.residue);
}

void add_tip(Fingerprint& print, TipJoint const& t) {
    print.add_each(t.type, t.axis, t.first_axis, t.pitch, t.rotation, t.translation, t.q);
    print.add_each(t.anchor.has_value(), t.anchor.value_or(Vec3::zero()), t.length);
    add_named(print, "ring", t.ring);
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

void add_chain(Fingerprint& print, ChainSpec const& chain) {
    print.add_each(chain.name, chain.base, chain.tip, chain.velocities);
    BeadArrays const& beads = chain.beads;
    print.add_each(beads.mass, beads.position, beads.velocity, beads.length, beads.residue,
                   beads.anchor);
    BodyArrays const& b = chain.bodies;
    print.add_each(b.mass, b.com, b.inertia, b.joint, b.axis, b.rotation, b.translation, b.q, b.qd,
                   b.free_position, b.free_velocity);
    print.add_each(b.torque, b.stiffness, b.damping, b.rest, b.wrench);
    add_named(print, "first axes", !b.first_axis.empty(), b.first_axis);
    add_named(print, "pitches", !b.pitch.empty(), b.pitch);
    add_named(print, "drag", !b.drag.empty(), b.drag);
    add_driven(print, b.driven);
    add_carried(print, b.carried);
    add_linked(print, chain.linked);
    if (chain.tip == Tip::jointed) add_tip(print, chain.tip_joint);
    add_named(print, "parents", chain.is_branched(), chain.parent);
}

}  // namespace

std::string fingerprint(Scene const& scene) {
    Fingerprint print;
    print.add(std::string("catena scene 1"));
    print.add_each(scene.si, scene.box.has_value(), scene.box.value_or(Vec3::zero()),
                   scene.forces.gravity, scene.chains.size());
    for (ChainSpec const& chain : scene.chains) add_chain(print, chain);
    print.add(scene.forces.openmm.has_value());
    if (scene.forces.openmm) {
        OpenMmSpec const& o = *scene.forces.openmm;
        print.add_each(o.builder, content_of(o.system), content_of(o.topology), chain_map(o),
                       o.temperature, o.ionic_strength, o.ph, o.switch_width);
        print.add(o.force_groups);
        ForceChanges const changes = changes_of(o);
        add_named(print, "left out", !changes.leave_out.empty(), changes.leave_out);
        for (auto const& [force, length] : changes.links)
            add_named(print, "links", true, force, length);
        for (std::string const& file : changes.extra)
            add_named(print, "extra", true, content_of(file));
    }
    DynamicsSpec const& d = scene.dynamics;
    ForceSpec const& f = scene.forces;
    add_named(print, "scene drag", f.linear_drag != 0 || f.angular_drag != 0, f.linear_drag,
              f.angular_drag);
    print.add_each(d.given, traits_of(d.integrator).code, d.step, d.temperature, d.friction, d.seed,
                   d.constraint_tolerance);
    add_named(print, "fixman", d.fixman);
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
}

void add_loads(Fingerprint& print, BodyArrays const& b) {
    print.add_each(b.torque, b.stiffness, b.damping, b.rest, b.wrench, b.drag);
    add_driven(print, b.driven);
}

void add_positions(Fingerprint& print, ChainSpec const& chain) {
    print.add_each(chain.beads.position, chain.bodies.q, chain.bodies.free_position,
                   chain.linked.position, chain.linked.orientation);
}

void add_velocities(Fingerprint& print, ChainSpec const& chain) {
    print.add_each(chain.velocities, chain.beads.velocity, chain.bodies.qd,
                   chain.bodies.free_velocity, chain.linked.velocity, chain.linked.omega);
}

}  // namespace

ChainPrints prints_of(std::span<ChainSpec const> chains) {
    Fingerprint kind, loads, positions, velocities;
    for (ChainSpec const& chain : chains) {
        add_kind(kind, chain);
        add_loads(loads, chain.bodies);
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
