// A second reader of XML, far simpler than the scanner and written apart from it: what both say of
// a System must agree.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace catena::fuzz {

/// Types of the elements in the <Forces> of the root, in order, of a text that is well-formed XML
/// without document types and sections.
inline std::vector<std::string> plain_forces(std::string_view text) {
    std::vector<std::string> forces;
    std::vector<std::string_view> path;
    for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at)) {
        std::string_view const rest = text.substr(at);
        bool const comment = rest.starts_with("<!--"), end = rest.starts_with("</");
        if (comment || rest.starts_with("<?")) {
            at = comment ? text.find("-->", at + 4) : text.find("?>", at + 2);
            continue;
        }
        char quote = '\0';  // that a value is within
        std::string type, word, key;
        std::size_t to = at + (end ? 2 : 1);
        for (; to < text.size() && (quote != '\0' || text[to] != '>'); ++to) {
            char const c = text[to];
            if (quote == '\0' && (c == '"' || c == '\'')) {
                quote = c, key = word, word.clear();
            } else if (c == quote) {
                if (key == "type") type = word;
                quote = '\0', word.clear();
            } else if (quote != '\0' ||
                       std::string_view(" \t\r\n=/").find(c) == std::string_view::npos) {
                word += c;
            } else if (c != '=' && to + 1 < text.size() &&
                       std::string_view(" \t\r\n=").find(text[to + 1]) == std::string_view::npos) {
                word.clear();
            }
        }
        std::string_view const tag = text.substr(at + (end ? 2 : 1), to - at - (end ? 2 : 1));
        at = to;
        if (end) {
            if (!path.empty()) path.pop_back();
            continue;
        }
        if (path.size() == 2 && path[1] == "Forces") forces.push_back(type);
        if (!tag.ends_with('/')) path.push_back(tag.substr(0, tag.find_first_of(" \t\r\n/")));
    }
    return forces;
}

}  // namespace catena::fuzz
