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

/// Number of an attribute of the tag that begins at `tag`; nothing if it is no number.
std::optional<double> attribute_of(std::string const& text, std::size_t tag, char name) {
    std::size_t const end = text.find('>', tag);
    std::size_t const at = text.find({' ', name, '=', '"'}, tag);
    if (at == std::string::npos || at > end) return std::nullopt;
    std::size_t const first = at + 4, last = text.find('"', first);
    double value = 0;
    if (last == std::string::npos ||
        scene::parse_number(text.substr(first, last - first), value) != scene::NumberFault::none)
        return std::nullopt;
    return value;
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
            tag == std::string::npos ? std::nullopt : attribute_of(text_, tag, "xyz"[k]);
        if (!edge) return std::nullopt;
        edges[static_cast<int>(k)] = *edge;
    }
    return edges;
}

bool SystemText::holds(std::string const& kind) const {
    return text_.find('"' + kind + '"') != std::string::npos;
}

void SystemText::refuse_damaged() const {
    std::string const name = scene::shown_path(file_);
    scan_system_xml(text_, name, "forces of the scene");
}

}  // namespace catena::foreign
