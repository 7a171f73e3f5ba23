// Writes chains as YAML in flow style.
#include "catena/chain_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace catena {
namespace {

/// Returns a text in single quotes.
std::string quoted(std::string const& text) {
    std::string all = "'";
    for (char const c : text) all += c == '\'' ? "''" : std::string(1, c);
    return all + "'";
}
std::string list(std::span<double const> numbers) {
    return fmt::format("[{}]", fmt::join(numbers, ", "));
}
std::string list(std::span<Triple const> rows) {
    std::vector<std::string> texts;
    texts.reserve(rows.size());
    for (Triple const& row : rows) texts.push_back(list(std::span<double const>(row)));
    return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// A map in flow style.
class Map {
  public:
    void text(char const* key, std::string const& value) {
        entries_.push_back(fmt::format("{}: {}", key, value));
    }
    void number(char const* key, std::optional<double> const& value) {
        if (value) text(key, fmt::format("{}", *value));
    }
    void triple(char const* key, std::optional<Triple> const& value) {
        if (value) text(key, list(std::span<double const>(*value)));
    }
    /// Adds numbers: none if the list is empty, one as a scalar.
    void numbers(char const* key, std::vector<double> const& values) {
        if (values.size() == 1) number(key, values.front());
        if (values.size() > 1) text(key, list(std::span<double const>(values)));
    }
    void further(FurtherKeys const& keys) {
        for (auto const& [key, value] : keys) text(key.c_str(), value);
    }
    std::string str() const { return fmt::format("{{{}}}", fmt::join(entries_, ", ")); }

  private:
    std::vector<std::string> entries_;
};

/// Adds a free joint's position and rate as maps if they have as many numbers as a free joint.
void add_free(Map& map, Joint const& joint) {
    std::span<double const> const q(joint.q), qd(joint.qd);
    if (q.size() == 7)
        map.text("q", fmt::format("{{position: {}, quaternion: {}}}", list(q.first(3)),
                                  list(q.last(4))));
    else
        map.numbers("q", joint.q);
    if (qd.size() == 6)
        map.text("qd",
                 fmt::format("{{omega: {}, velocity: {}}}", list(qd.first(3)), list(qd.last(3))));
    else
        map.numbers("qd", joint.qd);
}

std::string text_of(Joint const& joint) {
    Map map;
    map.text("type", quoted(joint.type));
    map.triple("axis", joint.axis);
    if (!joint.axes.empty()) map.text("axes", list(joint.axes));
    if (joint.translation != Triple{}) map.triple("translation", joint.translation);
    if (joint.rotation) map.text("rotation", list(*joint.rotation));
    map.number("pitch", joint.pitch);
    if (joint.type == "free") {
        add_free(map, joint);
    } else {
        map.numbers("q", joint.q);
        map.numbers("qd", joint.qd);
    }
    map.numbers("torque", joint.torque);
    map.numbers("stiffness", joint.stiffness);
    map.numbers("damping", joint.damping);
    map.numbers("rest", joint.rest);
    map.further(joint.keys);
    return map.str();
}

std::string text_of(Body const& body) {
    Map map;
    map.number("mass", body.mass);
    if (body.com != Triple{}) map.triple("com", body.com);
    map.text("inertia", list(body.inertia));
    if (body.parent) map.text("parent", std::to_string(*body.parent));
    if (body.joint) map.text("joint", text_of(*body.joint));
    map.further(body.keys);
    return map.str();
}

/// `has_link`: a link connects the bead to another one, or to the ground.
std::string text_of(Bead const& bead, bool has_link) {
    Map map, link;
    map.number("mass", bead.mass);
    map.triple("position", bead.position);
    map.triple("velocity", bead.velocity);
    if (!bead.residue.empty()) map.text("residue", quoted(bead.residue));
    if (bead.parent) map.text("parent", std::to_string(*bead.parent));
    link.text("type", "link");
    link.number("length", bead.length);
    if (has_link || bead.length) map.text("joint", link.str());
    return map.str();
}

}  // namespace

std::string text_of(Chain const& chain) {
    std::vector<std::string> lines;
    for (Body const& body : chain.bodies) lines.push_back(text_of(body));
    for (Bead const& bead : chain.beads)
        lines.push_back(text_of(bead, !lines.empty() || chain.fixed_base));
    Map map;
    if (!chain.name.empty()) map.text("name", quoted(chain.name));
    if (chain.fixed_base) map.text("base", "fixed");
    map.triple("anchor", chain.anchor);
    map.further(chain.keys);
    if (!lines.empty()) map.text("bodies", fmt::format("[\n    {}]", fmt::join(lines, ",\n    ")));
    return "  - " + map.str() + "\n";
}

}  // namespace catena
