// Implements the reader of domain files.
#include "domains/domain_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "error.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"

namespace catena::scene {

namespace {

char const* const form =
    "write `NAME: [[first, last], ...]`, with residues counted from 1 along the chain";

/// Parses the file. Throws InputError for one that names no protein.
std::unique_ptr<Node> parsed(std::string const& text, std::string const& path) {
    if (holds_no_keys(text))
        throw InputError("the domain file names no protein", shown_path(path), form);
    return parse_document(text, path);
}

/// The protein's entry in the file. Throws InputError if no name decides.
Node const& protein_in(Node const& file, Node const& at, std::string const& wanted,
                       std::string const& chain) {
    if (Node const* const named = file.find(wanted.empty() ? chain : wanted)) return *named;
    if (wanted.empty() && file.items.size() == 1) return file.items[0];
    std::vector<std::string> keys;
    for (std::size_t k = 0; k < std::min<std::size_t>(file.items.size(), 8); ++k)
        keys.push_back(shown(file.items[k].key));
    std::vector<std::string_view> const names(keys.begin(), keys.end());
    fail(at,
         fmt::format("`{}` has no protein `{}`", shown_path(file.text),
                     shown(wanted.empty() ? chain : wanted)),
         fmt::format("name one as `protein`: {}{}", joined(names),
                     file.items.size() > 8 ? ", ..." : ""));
}

/// Number of a residue. Throws InputError for one below 1.
std::int64_t residue_of(Node const& node) {
    std::int64_t const residue = whole(node, std::numeric_limits<std::int64_t>::min());
    if (residue < 1) fail(node, fmt::format("a domain has a residue {}", residue), form);
    return residue;
}

std::array<std::int64_t, 2> segment_of(Node const& node) {
    if (node.kind != Node::Kind::list || node.items.size() != 2)
        fail(node, describe(node) + " is not a pair of residues", form);
    std::array<std::int64_t, 2> const pair{residue_of(node.items[0]), residue_of(node.items[1])};
    if (pair[1] < pair[0])
        fail(node, fmt::format("the last residue, {}, precedes the first, {}", pair[1], pair[0]),
             form);
    return pair;
}

DomainSegments domain_of(Node const& node) {
    bool const several = node.kind == Node::Kind::list && !node.items.empty() &&
                         node.items[0].kind == Node::Kind::list;
    if (!several) return {segment_of(node)};
    DomainSegments segments;
    for (Node const& item : node.items) segments.push_back(segment_of(item));
    return segments;
}

}  // namespace

FileDomains read_domain_file(std::string const& path, Node const& at, std::string const& wanted,
                             std::string const& chain) {
    auto const file = parsed(read_text_file(path, at), path);
    Node const& protein = protein_in(*file, at, wanted, chain);
    FileDomains made{protein.key, {}};
    if (protein.kind != Node::Kind::list || protein.items.empty())
        fail(protein, fmt::format("protein `{}` has no list of domains", shown(protein.key)), form);
    for (Node const& item : protein.items) made.domains.push_back(domain_of(item));
    return made;
}

}  // namespace catena::scene
