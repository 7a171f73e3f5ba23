// Implements the numbering of residues.
#include "domains/residue_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/fields.hpp"

namespace catena::scene {

namespace {

/// Largest number of a residue that is read as a whole number.
double constexpr largest_number = 1e15;

bool is_whole(std::string const& text, double& value) {
    return parse_number(text, value) == NumberFault::none && value == std::floor(value) &&
           std::abs(value) < largest_number;
}

}  // namespace

std::size_t ResidueNumbers::chain_of(std::size_t residue) const {
    if (begins.empty()) return 0;
    auto const next = std::upper_bound(begins.begin(), begins.end(), residue);
    return static_cast<std::size_t>(next - begins.begin()) - 1;
}

std::array<std::size_t, 2> ResidueNumbers::range_of(std::size_t chain) const {
    if (begins.empty()) return {0, residues};
    return {begins[chain], chain + 1 < begins.size() ? begins[chain + 1] : residues};
}

bool ResidueNumbers::several_names() const {
    return std::any_of(chains.begin(), chains.end(),
                       [&](auto const& chain) { return chain != chains[0]; });
}

bool ResidueNumbers::count_from_one() const {
    for (std::size_t k = 0; k < labels.size(); ++k)
        if (labels[k] != std::to_string(k + 1)) return false;
    return true;
}

std::string ResidueNumbers::label(std::size_t residue) const {
    return labels.empty() ? std::to_string(residue + 1) : shown(labels[residue]);
}

std::string ResidueNumbers::span(std::size_t first, std::size_t last) const {
    std::string text = first == last ? "residue " + label(first)
                                     : fmt::format("residues {} to {}", label(first), label(last));
    if (several_names()) text += " of chain " + shown(chains[first][0]);
    return text;
}

Numbering::Numbering(ResidueNumbers const& numbers) : numbers_(numbers) {
    for (std::size_t k = 0; k < numbers.labels.size(); ++k)
        residues_[numbers.labels[k]].push_back(k);
}

std::string Numbering::remedy() const {
    if (numbers_.labels.empty())
        return fmt::format("give [first, last] with residues from 1 to {}, both included",
                           numbers_.residues);
    return fmt::format(
        "give [first, last] with the file's residue numbers, here {} to {}, both included",
        numbers_.labels.front(), numbers_.labels.back());
}

Domain Numbering::range(Node const& node) const {
    std::array<ResidueName, 2> const ends = ends_of(node);
    Domain range{residue(node, ends[0]), residue(node, ends[1])};
    range.name = fmt::format("residues {} to {}", shown(ends[0].label), shown(ends[1].label));
    if (!ends[0].chain.empty()) range.name += " of chain " + shown(ends[0].chain);
    if (range.last < range.first)
        fail(node,
             range.name +
                 " do not form a rigid body, which needs three residues that do not lie on one "
                 "line",
             remedy());
    return range;
}

bool Numbering::is_list_of_ranges(Node const& node) {
    auto const is_range = [](Node const& item) {
        if (item.kind == Node::Kind::list) return true;
        return item.kind == Node::Kind::scalar && (item.text.find('-', 1) != std::string::npos ||
                                                   item.text.find(':') != std::string::npos);
    };
    return node.kind == Node::Kind::list &&
           std::any_of(node.items.begin(), node.items.end(), is_range);
}

std::array<ResidueName, 2> Numbering::ends_of(Node const& node) const {
    if (node.kind == Node::Kind::scalar) return ends_in(node);
    if (node.kind != Node::Kind::list || node.items.size() != 2)
        fail(node, describe(node) + " is not a pair of residues", remedy());
    return {{{"", label(node.items[0])}, {"", label(node.items[1])}}};
}

/// Reads "A:1-95". Numbers may be negative: "A:-3-10".
std::array<ResidueName, 2> Numbering::ends_in(Node const& node) const {
    std::string const written = text(node);
    std::size_t const colon = written.rfind(':');
    std::string const chain = colon == std::string::npos ? "" : written.substr(0, colon);
    std::string const span = colon == std::string::npos ? written : written.substr(colon + 1);
    std::size_t const dash = span.find('-', 1);
    if (dash == std::string::npos || dash + 1 == span.size() || colon == 0)
        fail(node, describe(node) + " is not a range of residues",
             "write CHAIN:FIRST-LAST, such as \"A:1-95\", or [1, 95]");
    return {{{chain, span.substr(0, dash)}, {chain, span.substr(dash + 1)}}};
}

/// True if the residue lies in the chain; every residue does if none is named.
bool Numbering::in_chain(std::size_t residue, std::string const& chain) const {
    if (chain.empty()) return true;
    if (residue >= numbers_.chains.size()) return false;
    // Author names come first, as for `chain`; labels count where no author name matches.
    bool const is_author_name = std::any_of(numbers_.chains.begin(), numbers_.chains.end(),
                                            [&](auto const& names) { return names[0] == chain; });
    return numbers_.chains[residue][is_author_name ? 0 : 1] == chain;
}

/// Residue (from 0) of one end. Throws InputError for unknown and ambiguous numbers.
std::size_t Numbering::residue(Node const& node, ResidueName const& end) const {
    if (numbers_.labels.empty()) return counted_residue(node, end);
    auto const known = residues_.find(end.label);
    std::vector<std::size_t> found;
    for (std::size_t const k : known == residues_.end() ? found : known->second)
        if (in_chain(k, end.chain)) found.push_back(k);
    if (found.empty())
        fail(node,
             fmt::format("residue {}{} is not in the file", shown(end.label),
                         end.chain.empty() ? "" : " of chain " + shown(end.chain)),
             remedy());
    if (found.size() > 1)
        fail(node,
             fmt::format("{} residues of the file have the number {}", found.size(),
                         shown(end.label)),
             numbers_.several_names() && end.chain.empty()
                 ? "name the chain, such as \"" + numbers_.chains[found[0]][0] + ":" + end.label +
                       "-...\""
                 : "give each residue its own number or insertion code");
    return found[0];
}

/// Residue of a number that counts residues from 1.
std::size_t Numbering::counted_residue(Node const& node, ResidueName const& end) const {
    if (!end.chain.empty())
        fail(node, fmt::format("chain {} is no chain of a file", shown(end.chain)), remedy());
    double value = 0;
    if (!is_whole(end.label, value))
        fail(node, fmt::format("`{}` is no residue", shown(end.label)), remedy());
    if (value < 1 || value > static_cast<double>(numbers_.residues))
        fail(node,
             fmt::format("residue {} of a chain of {}", static_cast<std::int64_t>(value),
                         numbers_.residues),
             remedy());
    return static_cast<std::size_t>(value) - 1;
}

/// Returns whole numbers in plain form ("7" for "7.0"), other labels as written. Without labels of
/// a file the number must be a whole one from 1 on.
std::string Numbering::label(Node const& end) const {
    if (numbers_.labels.empty()) return std::to_string(whole(end, 1));
    double value = 0;
    std::string const written = text(end);
    return is_whole(written, value) ? std::to_string(static_cast<std::int64_t>(value)) : written;
}

}  // namespace catena::scene
