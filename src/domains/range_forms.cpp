// Implements the messages on the form of ranges.
#include "domains/range_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/fields.hpp"

namespace catena::scene {

namespace {

/// Place after a residue number with a sign and an insertion code that begins at `at`; `at` if
/// there is none.
std::size_t after_number(std::string const& text, std::size_t at) {
    std::size_t end = at < text.size() && text[at] == '-' ? at + 1 : at;
    std::size_t const digits = end;
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
    if (end == digits) return at;
    bool const coded =
        end < text.size() && std::isalpha(static_cast<unsigned char>(text[end])) != 0;
    return coded ? end + 1 : end;
}

/// True for "1-72", "-3-10" and "52A - 60".
bool is_span(std::string const& text) {
    std::size_t at = after_number(text, 0);
    if (at == 0) return false;
    while (at < text.size() && text[at] == ' ') ++at;
    if (at == text.size() || text[at] != '-') return false;
    do ++at;
    while (at < text.size() && text[at] == ' ');
    std::size_t const end = after_number(text, at);
    return end > at && end == text.size();
}

/// True for a span with or without "CHAIN:".
bool is_range(std::string const& text) {
    std::size_t const colon = text.rfind(':');
    return is_span(without_blanks(colon == std::string::npos ? text : text.substr(colon + 1)));
}

/// Parts of a text between commas, semicolons or blanks.
std::vector<std::string> parts_of(std::string const& text, char const* marks) {
    std::vector<std::string> parts;
    std::size_t at = 0;
    while (at < text.size()) {
        std::size_t const end = std::min(text.find_first_of(marks, at), text.size());
        if (std::string part = without_blanks(text.substr(at, end - at)); !part.empty())
            parts.push_back(std::move(part));
        at = end + 1;
    }
    return parts;
}

/// Ranges in quotes, joined by commas.
std::string quoted(std::vector<std::string> const& ranges) {
    std::string text;
    for (std::string const& range : ranges)
        text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", shown(range));
    return text;
}

}  // namespace

bool is_map_of_ranges(Node const& node) {
    return node.kind == Node::Kind::map && !node.items.empty() &&
           std::all_of(node.items.begin(), node.items.end(), [](Node const& item) {
               return item.kind == Node::Kind::scalar && is_span(without_blanks(item.text));
           });
}

void refuse_map(Node const& node) {
    if (!is_map_of_ranges(node))
        fail(node, "a map is not a range of residues",
             "write ranges in quotes, such as \"A:1-95\"");
    std::vector<std::string> ranges;
    for (Node const& item : node.items)
        ranges.push_back(item.key + ":" + without_blanks(item.text));
    Node const& first = node.items.front();
    fail(node,
         fmt::format("YAML makes a map of `{}: {}`, which is not a range of residues",
                     shown(first.key), shown(first.text)),
         fmt::format("write [{}], in quotes and without a blank", quoted(ranges)));
}

void refuse_printed_dash(Node const& node) {
    std::string hyphened = text(node);
    bool is_printed = false;
    for (std::string_view const dash : {"\u2013", "\u2014", "\u2212"})
        for (auto at = hyphened.find(dash); at != std::string::npos; at = hyphened.find(dash)) {
            hyphened.replace(at, dash.size(), "-");
            is_printed = true;
        }
    if (is_printed)
        fail(node, describe(node) + " has a dash that is no hyphen",
             fmt::format("write \"{}\"", shown(hyphened)));
}

void refuse_several_ranges(Node const& node) {
    std::string const written = text(node);
    for (char const* const marks : {",;", ",; \t"}) {
        std::vector<std::string> const parts = parts_of(written, marks);
        if (parts.size() < 2 || !std::all_of(parts.begin(), parts.end(), is_range)) continue;
        fail(node, fmt::format("{} holds {} ranges", describe(node), parts.size()),
             fmt::format("write each in quotes of its own: {}; [{}] makes one body of them",
                         quoted(parts), quoted(parts)));
    }
}

}  // namespace catena::scene
