// Implements the change of places in refusals.
#include "foreign/origins.hpp"

#include <cctype>

#include "scene/node.hpp"

namespace catena::foreign {

namespace {

/// File, key or option that a key of the scene comes from.
std::string origin_of(std::string const& key, SceneDraft const& draft) {
    auto const known = draft.settings.origins.find(key);
    if (known != draft.settings.origins.end()) return known->second;
    if (key == "forces.openmm.topology") return scene::shown_path(draft.start);
    if (key.starts_with("forces.openmm.leave_out")) return "--leave-out";
    if (key.starts_with("forces.openmm.links")) return "--links";
    if (key.starts_with("forces.openmm") || key.starts_with("box"))
        return scene::shown_path(draft.system);
    return draft.source;
}

/// End of the key that begins at `at`: letters, digits, points, brackets and underscores.
std::size_t end_of_key(std::string const& text, std::size_t at) {
    auto const is_part = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' ||
               c == '[' || c == ']';
    };
    while (at < text.size() && is_part(text[at])) ++at;
    return at;
}

/// Removes ", line 9", which counts lines of the scene, from the place that begins at `at`.
void remove_line(std::string& text, std::size_t at) {
    std::string const mark = ", line ";
    std::size_t const line = text.find(mark, at), close = text.find(')', at);
    if (line > close) return;
    std::size_t end = line + mark.size();
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
    text.erase(line, end - line);
}

}  // namespace

std::string with_origins(std::string const& refusal, SceneDraft const& draft) {
    std::string const file = scene::shown_path(draft.file), place = "(" + file;
    std::string text = refusal;
    for (auto at = text.find(place); at != std::string::npos; at = text.find(place, at + 1)) {
        std::size_t const after = at + place.size();
        bool const keyed = text.compare(after, 2, ": ") == 0;
        std::size_t const begin = keyed ? after + 2 : after;
        std::size_t const end = keyed ? end_of_key(text, begin) : after;
        std::string const origin = origin_of(text.substr(begin, end - begin), draft);
        remove_line(text, end);
        text.replace(at + 1, end - at - 1, origin);
    }
    return text;
}

}  // namespace catena::foreign
