#include "tests/support/shrink.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "oracle/oracle.hpp"

namespace catena::test {
namespace {

/// Keeps entries [first, last) of an array that has one a body; others are left alone.
struct Cut {
    std::size_t first, last, size;
    template <class T>
    void operator()(std::vector<T>& values) const {
        if (values.size() != size) return;
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(last), values.end());
        values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first));
    }
    void operator()(CarriedBeads& beads) const {
        if (beads.offset.size() != size + 1) return;
        std::int64_t const begin = beads.offset[first], end = beads.offset[last];
        Cut const of_beads{static_cast<std::size_t>(begin), static_cast<std::size_t>(end),
                           beads.position.size()};
        of_beads(beads.position), of_beads(beads.mass), of_beads(beads.residue);
        Cut{first, last + 1, size + 1}(beads.offset);
        for (std::int64_t& o : beads.offset) o -= begin;
    }
    void operator()(std::vector<DrivenJoint>& driven) const {
        std::erase_if(driven, [&](DrivenJoint const& d) {
            auto const body = static_cast<std::size_t>(d.body);
            return body < first || body >= last;
        });
        for (DrivenJoint& d : driven) d.body -= static_cast<std::int64_t>(first);
    }
};

void cut_bodies(ChainSpec& chain, Cut const& cut) {
    BodyArrays& b = chain.bodies;
    cut(b.driven), cut(b.carried);
    cut(b.mass), cut(b.com), cut(b.inertia), cut(b.joint), cut(b.axis), cut(b.rotation),
        cut(b.translation), cut(b.q), cut(b.qd);
    cut(b.first_axis), cut(b.pitch), cut(b.torque), cut(b.stiffness), cut(b.damping), cut(b.rest),
        cut(b.wrench), cut(b.drag);
    if (chain.base == Base::fixed || cut.first == 0) return;
    auto const clear = [](auto& values, auto zero) {
        if (!values.empty()) values[0] = zero;
    };
    b.joint[0] = JointType::free;  // where its joint frame was; nothing else is left of the joint
    b.q[0] = {1, 0, 0, 0};
    b.free_base.position = b.translation[0];
    clear(b.torque, Vec3::zero()), clear(b.stiffness, Vec3::zero()), clear(b.damping, Vec3::zero()),
        clear(b.first_axis, Vec3::zero());
    clear(b.pitch, 0.0), clear(b.rest, b.q[0]);
    std::erase_if(b.driven, [](DrivenJoint const& d) { return d.body == 0; });
}

/// Bodies [first, last) of the chain, closed as the chain was.
ChainSpec part(ChainSpec chain, std::size_t first, std::size_t last, double time) {
    Cut const cut{first, last, chain.size()};
    if (chain.is_beads()) {
        BeadArrays& b = chain.beads;
        if (first > 0) b.anchor = b.position[first - 1];
        cut(b.mass), cut(b.position), cut(b.velocity), cut(b.length), cut(b.residue);
    } else if (chain.is_linked()) {
        LinkedArrays& b = chain.linked;
        if (first > 0) b.anchor = b.position[first - 1];
        cut(b.carried);
        cut(b.mass), cut(b.inertia), cut(b.position), cut(b.velocity), cut(b.orientation),
            cut(b.omega), cut(b.inboard), cut(b.outboard);
        cut(b.length);
    } else {
        cut_bodies(chain, cut);
    }
    oracle::project_velocities(chain, time);
    return chain;
}

void zero(std::vector<Vec3>& values) { std::fill(values.begin(), values.end(), Vec3::zero()); }

void clear_velocities(ChainSpec& chain) {
    zero(chain.bodies.qd), zero(chain.beads.velocity), zero(chain.linked.velocity),
        zero(chain.linked.omega);
    chain.bodies.free_base.velocity = Vec3::zero();
}

/// What may be left out as a whole.
std::vector<void (*)(ChainSpec&)> simplifications() {
    return {[](ChainSpec& c) { c.bodies.wrench.clear(); },
            [](ChainSpec& c) { c.bodies.torque.clear(); },
            [](ChainSpec& c) { c.bodies.stiffness.clear(), c.bodies.rest.clear(); },
            [](ChainSpec& c) { c.bodies.damping.clear(); },
            [](ChainSpec& c) { c.bodies.drag.clear(); },
            [](ChainSpec& c) { c.bodies.driven.clear(); },
            clear_velocities,
            [](ChainSpec& c) { c.tip = Tip::free; }};
}

class Shrinking {
  public:
    Shrinking(ChainSpec const& chain, std::function<bool(ChainSpec const&)> const& holds,
              double time)
        : chain_(chain), holds_(holds), time_(time) {}

    ChainSpec run() {
        for (std::size_t drop = chain_.size(); drop > 0; drop /= 2) {
            while (drop < chain_.size() && keep(part(chain_, 0, chain_.size() - drop, time_))) {
            }
            while (drop < chain_.size() && keep(part(chain_, drop, chain_.size(), time_))) {
            }
        }
        for (auto const& simplify : simplifications()) {
            ChainSpec simpler = chain_;
            simplify(simpler);
            keep(simpler);
        }
        return chain_;
    }

  private:
    bool keep(ChainSpec const& candidate) {
        bool fails = false;
        try {
            fails = !holds_(candidate);
        } catch (std::exception const&) {
            fails = true;
        }
        if (fails) chain_ = candidate;
        return fails;
    }
    ChainSpec chain_;
    std::function<bool(ChainSpec const&)> const& holds_;
    double time_;
};

std::string text(Vec3 const& v) {
    return fmt::format("({:.17g}, {:.17g}, {:.17g})", v[0], v[1], v[2]);
}
std::string text(std::array<double, 4> const& q) {
    return fmt::format("({:.17g}, {:.17g}, {:.17g}, {:.17g})", q[0], q[1], q[2], q[3]);
}
std::string text(Sym3 const& s) {
    return fmt::format("[{:.17g}]", fmt::join(s.data, s.data + 6, ", "));
}
std::string text(Mat3 const& m) {
    return fmt::format("[{:.17g}]", fmt::join(m.data, m.data + 9, ", "));
}

std::string describe_body(BodyArrays const& b, std::size_t k) {
    std::string line = fmt::format(
        "  {} {}: mass {:.17g}, com {}, inertia {}, axis {}, rotation {}, translation {}, q {}, qd "
        "{}",
        k + 1, name_of(b.joint[k]), b.mass[k], text(b.com[k]), text(b.inertia[k]), text(b.axis[k]),
        text(b.rotation[k]), text(b.translation[k]), text(b.q[k]), text(b.qd[k]));
    auto const add = [&](char const* name, auto const& values) {
        if (!values.empty()) line += fmt::format(", {} {}", name, text(values[k]));
    };
    if (!b.first_axis.empty()) line += ", first axis " + text(b.first_axis[k]);
    if (b.joint[k] == JointType::helical) line += fmt::format(", pitch {:.17g}", b.pitch[k]);
    add("torque", b.torque), add("stiffness", b.stiffness), add("damping", b.damping),
        add("rest", b.rest);
    if (!b.wrench.empty())
        line += fmt::format(", wrench {} {}", text(b.wrench[k].first), text(b.wrench[k].second));
    if (!b.drag.empty()) line += fmt::format(", drag {:.17g} {:.17g}", b.drag[k][0], b.drag[k][1]);
    for (DrivenJoint const& d : b.driven)
        if (static_cast<std::size_t>(d.body) == k)
            for (PrescribedMotion const& c : d.course)
                line += fmt::format(", driven {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}", c.offset,
                                    c.rate, c.amplitude, c.frequency, c.phase);
    return line + "\n";
}

}  // namespace

std::string describe(ChainSpec const& chain) {
    std::string lines = fmt::format(
        "{} bodies, base {}, tip {}\n", chain.size(), chain.base == Base::fixed ? "fixed" : "free",
        chain.tip == Tip::free ? "free" : name_of(chain.tip_joint.type));
    BodyArrays const& b = chain.bodies;
    if (b.size() > 0 && chain.base == Base::free)
        lines += fmt::format("  position {}, velocity {}\n", text(b.free_base.position),
                             text(b.free_base.velocity));
    for (std::size_t k = 0; k < b.size(); ++k) lines += describe_body(b, k);
    for (std::size_t k = 0; k < chain.beads.size(); ++k)
        lines += fmt::format("  {} bead: mass {:.17g}, position {}, velocity {}\n", k + 1,
                             chain.beads.mass[k], text(chain.beads.position[k]),
                             text(chain.beads.velocity[k]));
    LinkedArrays const& l = chain.linked;
    for (std::size_t k = 0; k < l.size(); ++k)
        lines += fmt::format(
            "  {} {}: mass {:.17g}, inertia {}, position {}, velocity {}, q {}, omega {}, inboard "
            "{}, outboard {}\n",
            k + 1, l.is_bead(k) ? "bead" : "body", l.mass[k], text(l.inertia[k]),
            text(l.position[k]), text(l.velocity[k]), text(l.orientation[k]), text(l.omega[k]),
            text(l.inboard[k]), text(l.outboard[k]));
    if (chain.base == Base::fixed && b.size() == 0)
        lines +=
            fmt::format("  anchor {}\n", text(chain.is_beads() ? chain.beads.anchor : l.anchor));
    TipJoint const& t = chain.tip_joint;
    if (chain.tip == Tip::jointed)
        lines += fmt::format(
            "  tip: axis {}, first axis {}, pitch {:.17g}, rotation {}, translation {}, q {}, "
            "anchor {}\n",
            text(t.axis), text(t.first_axis), t.pitch, text(t.rotation), text(t.translation),
            text(t.q), t.anchor ? text(*t.anchor) : "none");
    return lines;
}

Shrunk shrink(ChainSpec const& chain, std::function<bool(ChainSpec const&)> const& holds,
              double time) {
    ChainSpec const smallest = Shrinking(chain, holds, time).run();
    return {smallest, describe(smallest)};
}

}  // namespace catena::test
