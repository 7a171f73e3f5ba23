// Implements the messages on the form of ranges.
#include "domains/range_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/fields.hpp"

namespace catena::scene {

namespace {

std::size_t constexpr longest_form = 40;  // characters of a range in another form

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

/// Chain of a range with its colon, "A:" of "A:1-72"; empty without one.
std::string chain_in(std::string const& range) { return range.substr(0, range.rfind(':') + 1); }

/// Ranges in quotes, joined by commas.
std::string quoted(std::vector<std::string> const& ranges) {
    std::string text;
    for (std::string const& range : ranges)
        text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", shown(range));
    return text;
}

/// Blanks and dashes of print with what a scene has in their place.
constexpr std::array<std::pair<std::string_view, std::string_view>, 10> printed = {
    {{"\u2013", "-"},
     {"\u2014", "-"},
     {"\u2212", "-"},
     {"\u2010", "-"},
     {"\u2011", "-"},
     {"\u00a0", ""},
     {"\u2007", ""},
     {"\u202f", ""},
     {"\u2009", ""},
     {"\u200b", ""}}};

/// Replaces blanks and dashes of print. `dashes` and `spaces` receive their numbers.
std::string plain(std::string text, int& dashes, int& spaces) {
    for (auto const& [mark, other] : printed)
        for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at)) {
            text.replace(at, mark.size(), other);
            ++(other.empty() ? spaces : dashes);
        }
    return text;
}

/// True for a range of a chain that the file has, whatever its name: "1-2:5-20".
bool is_range_of_chain(std::string const& text, IsChain const& is_chain) {
    std::size_t const colon = text.rfind(':');
    return colon != std::string::npos && is_chain(without_blanks(text.substr(0, colon))) &&
           is_span(without_blanks(text.substr(colon + 1)));
}

/// Ranges that a text holds: "A:1-30, 41-72" has "A:1-30" and "A:41-72", "1-72:77-148" has two
/// unless "1-72" is a chain. Empty for a text with anything else.
std::vector<std::string> ranges_of(std::string const& text, IsChain const& is_chain) {
    if (is_range_of_chain(text, is_chain)) return {without_blanks(text)};
    int ignored = 0;
    std::string const written = plain(text, ignored, ignored);
    for (char const* const marks : {",;&+ \t", ",;&+"}) {
        std::vector<std::string> parts = parts_of(written, marks), ranges;
        std::string chain;
        for (std::string const& part : parts) {
            std::size_t const colon = part.rfind(':');
            std::string const before = colon == std::string::npos ? "" : part.substr(0, colon);
            if (is_range(before) && !is_chain(before)) {  // two ranges with a colon between them
                ranges.insert(ranges.end(), {before, chain_in(before) + part.substr(colon + 1)});
            } else {
                if (!chain_in(part).empty()) chain = chain_in(part);
                ranges.push_back(chain_in(part).empty() ? chain + part : part);
            }
        }
        if (!ranges.empty() && std::all_of(ranges.begin(), ranges.end(), is_range)) return ranges;
    }
    return {};
}

/// True for a scalar that is a residue's number, with or without an insertion code.
bool is_number(Node const& node) {
    std::string const text = without_blanks(node.text);
    return node.kind == Node::Kind::scalar && !text.empty() && after_number(text, 0) == text.size();
}

/// True for a list of two numbers.
bool is_pair(Node const& node) {
    return node.kind == Node::Kind::list && node.items.size() == 2 &&
           std::all_of(node.items.begin(), node.items.end(), is_number);
}

std::string span_of(Node const& pair) {
    return without_blanks(pair.items[0].text) + "-" + without_blanks(pair.items[1].text);
}

/// Ranges that an entry of a map stands for: `A: 1-72`, `A: [1, 72]`, `1-72: 77-148`.
std::vector<std::string> ranges_of_entry(Node const& entry, IsChain const& is_chain) {
    if (is_pair(entry)) return {entry.key + ":" + span_of(entry)};
    if (entry.kind != Node::Kind::scalar) return {};
    return ranges_of(entry.key + ":" + without_blanks(entry.text), is_chain);
}

/// Ranges that a node holds in any form and depth; empty if it holds something else, too.
std::vector<std::string> ranges_in(Node const& node, IsChain const& is_chain) {
    if (node.kind == Node::Kind::scalar) return ranges_of(node.text, is_chain);
    if (is_pair(node)) return {span_of(node)};
    std::vector<std::string> all;
    for (Node const& item : node.items) {
        auto const more = node.kind == Node::Kind::map ? ranges_of_entry(item, is_chain)
                                                       : ranges_in(item, is_chain);
        if (more.empty()) return {};
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

/// Advice with the forms of `rigid` that hold these ranges.
std::string forms_of(std::vector<std::string> const& ranges) {
    if (ranges.empty())
        return "write a list of ranges, such as rigid: [\"1-95\"], or with chains rigid: "
               "[\"A:1-95\"]";
    return ranges.size() == 1
               ? fmt::format("write rigid: [{}]", quoted(ranges))
               : fmt::format("write rigid: [{}] for a body of each, rigid: [[{}]] for one body",
                             quoted(ranges), quoted(ranges));
}

}  // namespace

bool is_map_of_ranges(Node const& node, IsChain const& is_chain) {
    return node.kind == Node::Kind::map && !node.items.empty() &&
           !ranges_in(node, is_chain).empty();
}

void refuse_map(Node const& node, IsChain const& is_chain) {
    std::vector<std::string> const ranges = ranges_in(node, is_chain);
    if (node.kind != Node::Kind::map || ranges.empty())
        fail(node, "a map is not a range of residues",
             "write ranges in quotes, such as \"A:1-95\"");
    Node const& first = node.items.front();
    fail(node,
         fmt::format("YAML makes a map of `{}: {}`, which is not a range of residues",
                     shown(first.key),
                     is_pair(first) ? "[" + first.items[0].text + ", " + first.items[1].text + "]"
                                    : shown(first.text)),
         ranges.size() == 1 || is_chain(first.key) || first.kind != Node::Kind::scalar ||
                 !is_range(first.key)
             ? fmt::format("write [{}], in quotes and without a blank", quoted(ranges))
             : forms_of(ranges));
}

void refuse_no_list(Node const& rigid, IsChain const& is_chain) {
    if (rigid.kind != Node::Kind::list)
        fail(rigid, describe(rigid) + " is not a list of ranges",
             forms_of(ranges_in(rigid, is_chain)));
    bool const bare =
        rigid.items.size() > 1 && std::all_of(rigid.items.begin(), rigid.items.end(), is_number);
    if (!bare) return;
    std::vector<std::string> ranges;
    for (std::size_t k = 0; k + 1 < rigid.items.size(); k += 2)
        ranges.push_back(without_blanks(rigid.items[k].text) + "-" +
                         without_blanks(rigid.items[k + 1].text));
    if (rigid.items.size() % 2 != 0) ranges.clear();
    fail(rigid, "a list of numbers is not a list of ranges", forms_of(ranges));
}

void refuse_depth(Node const& node, IsChain const& is_chain) {
    std::vector<std::string> const ranges = ranges_in(node, is_chain);
    if (!ranges.empty()) fail(node, "ranges stand in too many brackets", forms_of(ranges));
}

void refuse_printed(Node const& node) {
    int dashes = 0, spaces = 0;
    std::string const written = plain(text(node), dashes, spaces);
    if (dashes + spaces > 0)
        fail(node,
             describe(node) +
                 (dashes > 0 ? " has a dash that is no hyphen" : " has a non-breaking space"),
             fmt::format("write \"{}\"", shown(written)));
}

void refuse_several_ranges(Node const& node, IsChain const& is_chain) {
    std::vector<std::string> const ranges = ranges_of(text(node), is_chain);
    if (ranges.size() > 1)
        fail(
            node, fmt::format("{} holds {} ranges", describe(node), ranges.size()),
            fmt::format("write each in quotes of its own: {}; rigid: [[{}]] makes one body of them",
                        quoted(ranges), quoted(ranges)));
}

std::string likely_range(std::string const& written) {
    static std::regex const form(
        R"((?:([A-Za-z]\w?)\s*:|([A-Za-z]))?\s*(-?\d+[A-Za-z]?)\s*(?:to|\.{1,3}|[-:~/_])\s*)"
        R"((?:([A-Za-z]\w?)\s*:|([A-Za-z]))?\s*(-?\d+[A-Za-z]?))");
    std::smatch parts;
    if (written.size() > longest_form || !std::regex_match(written, parts, form)) return "";
    std::string const chain = parts[1].str() + parts[2].str(),
                      again = parts[4].str() + parts[5].str();
    if (!again.empty() && again != chain) return "";
    return (chain.empty() ? "" : chain + ":") + parts[3].str() + "-" + parts[6].str();
}

}  // namespace catena::scene
