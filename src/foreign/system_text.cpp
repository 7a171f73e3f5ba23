// Implements the search in the text of a serialised System.
#include "foreign/system_text.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "io/output_file.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "systems/xml_scan.hpp"

namespace catena::foreign {

namespace {

/// Text of an attribute of the tag that begins at `tag`; empty without it.
std::string attribute_text(std::string const& text, std::size_t tag, std::string const& name) {
    std::string_view const inside = std::string_view(text).substr(tag, text.find('>', tag) - tag);
    std::size_t const at = inside.find(' ' + name + "=\"");
    if (at == std::string_view::npos) return "";
    std::size_t const first = at + name.size() + 3, last = inside.find('"', first);
    return last == std::string_view::npos ? "" : std::string(inside.substr(first, last - first));
}

/// Number of such an attribute; nothing if it is no number.
std::optional<double> attribute_of(std::string const& text, std::size_t tag,
                                   std::string const& name) {
    double value = 0;
    std::string const written = attribute_text(text, tag, name);
    if (scene::parse_number(written, value) != scene::NumberFault::none) return std::nullopt;
    return value;
}

/// Text with the characters that XML escapes.
std::string unescaped(std::string text) {
    for (auto const& [escape, mark] :
         {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}})
        for (auto at = text.find(escape); at != std::string::npos; at = text.find(escape, at + 1))
            text.replace(at, std::string_view(escape).size(), mark);
    return text;
}

/// Calls `visit` for the tags in [at, end) that begin with `name`, such as "<Bond ".
template <class Visit>
void each_tag(std::string const& text, char const* name, std::size_t at, std::size_t end,
              Visit const& visit) {
    for (at = text.find(name, at); at < end; at = text.find(name, at + 1)) visit(at);
}

/// Tag of a bond or angle, and the attributes of its length or angle and of its stiffness.
struct BondTag {
    char const *tag, *length, *stiffness;
};

/// Reads the bonds in [at, end).
std::vector<BondText> bonds_of(std::string const& text, std::size_t at, std::size_t end,
                               BondTag const& form) {
    std::vector<BondText> bonds;
    each_tag(text, form.tag, at, end, [&](std::size_t tag) {
        auto const d = attribute_of(text, tag, form.length),
                   k = attribute_of(text, tag, form.stiffness), i = attribute_of(text, tag, "p1"),
                   j = attribute_of(text, tag, "p2");
        if (d && k && i && j)
            bonds.push_back({*d, *k, static_cast<std::int64_t>(*i), static_cast<std::int64_t>(*j),
                             attribute_of(text, tag, "param3").value_or(0)});
    });
    return bonds;
}

/// Reads the parameters of the particles in [at, end).
std::vector<std::array<double, 3>> parameters_of(std::string const& text, std::size_t at,
                                                 std::size_t end) {
    std::vector<std::array<double, 3>> parameters;
    each_tag(text, "<Particle ", at, end, [&](std::size_t tag) {
        parameters.push_back({attribute_of(text, tag, "param1").value_or(0),
                              attribute_of(text, tag, "param2").value_or(0),
                              attribute_of(text, tag, "param3").value_or(0)});
    });
    return parameters;
}

/// Reads the force whose tag begins at `at` and that ends before `next`.
ForceText force_of(std::string const& text, std::size_t at, std::size_t next) {
    ForceText force;
    force.kind = attribute_text(text, at, "type");
    force.energy = unescaped(attribute_text(text, at, "energy"));
    force.cutoff = attribute_of(text, at, "cutoff").value_or(0);
    force.periodic = attribute_text(text, at, "usesPeriodic") != "0";
    std::size_t const globals = text.find("<GlobalParameters>", at);
    if (globals < next)
        each_tag(text, "<Parameter ", globals, std::min(next, text.find("</GlobalP", at)),
                 [&](std::size_t tag) {
                     if (auto const value = attribute_of(text, tag, "default"))
                         force.globals[attribute_text(text, tag, "name")] = *value;
                 });
    if (force.kind == "HarmonicBondForce")
        force.bonds = bonds_of(text, at, next, {"<Bond ", "d", "k"});
    if (force.kind == "HarmonicAngleForce")
        force.bonds = bonds_of(text, at, next, {"<Angle ", "a", "k"});
    if (force.kind == "CustomBondForce")
        force.bonds = bonds_of(text, at, next, {"<Bond ", "param1", "param2"});
    if (force.kind == "CustomNonbondedForce") force.parameters = parameters_of(text, at, next);
    if (force.kind == "CustomExternalForce")
        each_tag(text, "<Particle ", at, next, [&](std::size_t tag) {
            if (auto const index = attribute_of(text, tag, "index"))
                force.pulled.push_back(static_cast<std::int64_t>(*index));
        });
    return force;
}

}  // namespace

SystemText::SystemText(std::string file) : file_(std::move(file)), text_(read_text_file(file_)) {}

std::size_t SystemText::particles() const {
    std::size_t const end = text_.find("</Particles>");
    std::size_t count = 0;
    for (auto at = text_.find("<Particle "); at < end; at = text_.find("<Particle ", at + 1))
        ++count;
    return count;
}

std::string SystemText::name() const {
    return scene::shown_path(std::filesystem::path(file_).filename().string());
}

std::optional<Vec3> SystemText::box() const {
    std::size_t const begin = text_.find("<PeriodicBoxVectors>");
    if (begin == std::string::npos) return std::nullopt;
    Vec3 edges;
    for (std::size_t k = 0; k < 3; ++k) {
        std::size_t const tag = text_.find({'<', "ABC"[k], ' '}, begin);
        auto const edge =
            tag == std::string::npos ? std::nullopt : attribute_of(text_, tag, {"xyz"[k]});
        if (!edge) return std::nullopt;
        edges[static_cast<int>(k)] = *edge;
    }
    return edges;
}

std::vector<double> SystemText::masses() const {
    std::vector<double> masses;
    each_tag(text_, "<Particle ", 0, text_.find("</Particles>"), [&](std::size_t tag) {
        if (auto const mass = attribute_of(text_, tag, "mass")) masses.push_back(*mass);
    });
    return masses;
}

std::vector<ForceText> const& SystemText::forces() const {
    if (forces_) return *forces_;
    forces_.emplace();
    std::size_t next = 0;
    for (std::size_t at = text_.find("<Force "); at != std::string::npos; at = next) {
        next = text_.find("<Force ", at + 1);
        forces_->push_back(force_of(text_, at, std::min(next, text_.size())));
    }
    return *forces_;
}

bool SystemText::holds(std::string const& kind) const {
    return text_.find('"' + kind + '"') != std::string::npos;
}

void SystemText::refuse_damaged() const {
    std::string const name = scene::shown_path(file_);
    scan_system_xml(text_, name, "forces of the scene");
}

}  // namespace catena::foreign
