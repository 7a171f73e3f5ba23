// Implements the search in the text of a serialised System.
#include "foreign/system_text.hpp"

#include <algorithm>
#include <utility>

#include "io/output_file.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "systems/xml_scan.hpp"

namespace catena::foreign {

namespace {

/// Text of an attribute of the tag that begins at `tag`; empty without it.
std::string attribute_text(std::string const& text, std::size_t tag, std::string const& name) {
    std::size_t const end = text.find('>', tag), at = text.find(' ' + name + "=\"", tag);
    if (at == std::string::npos || at > end) return "";
    std::size_t const first = at + name.size() + 3, last = text.find('"', first);
    return last == std::string::npos ? "" : text.substr(first, last - first);
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

}  // namespace

SystemText::SystemText(std::string file) : file_(std::move(file)), text_(read_text_file(file_)) {}

std::size_t SystemText::particles() const {
    std::size_t const end = text_.find("</Particles>");
    std::size_t count = 0;
    for (auto at = text_.find("<Particle "); at < end; at = text_.find("<Particle ", at + 1))
        ++count;
    return count;
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

std::vector<ForceText> SystemText::forces() const {
    std::vector<ForceText> forces;
    std::size_t next = 0;
    for (std::size_t at = text_.find("<Force "); at != std::string::npos; at = next) {
        next = text_.find("<Force ", at + 1);
        ForceText& force = forces.emplace_back();
        force.kind = attribute_text(text_, at, "type");
        force.energy = unescaped(attribute_text(text_, at, "energy"));
        std::size_t const end = std::min(next, text_.find("</GlobalParameters>", at));
        for (auto p = text_.find("<GlobalParameters>", at); end != std::string::npos && p < end;
             p = text_.find("<Parameter ", p + 1))
            if (auto const value = attribute_of(text_, p, "default"))
                force.globals[attribute_text(text_, p, "name")] = *value;
        if (force.kind != "HarmonicBondForce") continue;
        for (auto bond = text_.find("<Bond ", at); bond < next && bond != std::string::npos;
             bond = text_.find("<Bond ", bond + 1))
            if (auto const k = attribute_of(text_, bond, "k")) force.stiffness.insert(*k);
    }
    return forces;
}

bool SystemText::holds(std::string const& kind) const {
    return text_.find('"' + kind + '"') != std::string::npos;
}

void SystemText::refuse_damaged() const {
    std::string const name = scene::shown_path(file_);
    scan_system_xml(text_, name, "forces of the scene");
}

}  // namespace catena::foreign
