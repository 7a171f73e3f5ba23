// Implements the numbering of residues.
#include "domains/residue_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "domains/range_forms.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

namespace {

/// Largest number of a residue that is read as a whole number.
double constexpr largest_number = 1e15;
/// Largest number of chains that a message lists.
std::size_t constexpr most_listed = 4;

bool is_whole(std::string const& text, double& value) {
    return parse_number(text, value) == NumberFault::none && value == std::floor(value) &&
           std::abs(value) < largest_number;
}

/// A residue's label without its insertion code: "52" of "52A".
std::string without_code(std::string const& label) {
    bool const coded = label.size() > 1 && std::isalpha(static_cast<unsigned char>(label.back()));
    return coded ? label.substr(0, label.size() - 1) : label;
}

/// Names without repetition, joined by commas; the first eight.
std::string listed_once(std::vector<std::string> const& names) {
    std::vector<std::string> once;
    for (std::string const& name : names)
        if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
    std::string text;
    for (std::size_t k = 0; k < std::min<std::size_t>(once.size(), 8); ++k)
        text += (k == 0 ? "" : ", ") + (once[k].empty() ? "(no name)" : shown(once[k]));
    return once.size() > 8 ? text + ", ..." : text;
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

std::string Numbering::remedy(std::string const& chain) const {
    if (numbers_.labels.empty())
        return fmt::format("give [first, last] with residues from 1 to {}, both included",
                           numbers_.residues);
    if (numbers_.several_names()) return remedy_of_chains(chain);
    return fmt::format(
        "give [first, last] with the file's residue numbers, here {} to {}, both included",
        numbers_.label(0), numbers_.label(numbers_.labels.size() - 1));
}

/// Advice with the residues of the named chain, or of the first few chains.
std::string Numbering::remedy_of_chains(std::string const& chain) const {
    std::vector<std::string> each;
    std::size_t const residues = numbers_.labels.size();
    for (std::size_t first = 0, last = 0; first < residues; first = last + 1) {
        auto const& names = numbers_.chains[first];
        for (last = first; last + 1 < residues && numbers_.chains[last + 1] == names;) ++last;
        if (!chain.empty() && !in_chain(first, chain)) continue;
        each.push_back(fmt::format("\"{}:{}-{}\"", shown(chain.empty() ? names[0] : chain),
                                   numbers_.label(first), numbers_.label(last)));
    }
    bool const many = each.size() > most_listed;
    each.resize(std::min(each.size(), most_listed));
    return fmt::format("write \"CHAIN:FIRST-LAST\" within {}{}", fmt::join(each, ", "),
                       many ? ", ..." : "");
}

std::string Numbering::left_out_insertions(Domain const& range) const {
    std::vector<std::string> names;
    for (std::size_t k = range.last + 1; k < numbers_.labels.size(); ++k) {
        bool const follows = numbers_.chains[k] == numbers_.chains[range.last] &&
                             numbers_.labels[k] != numbers_.labels[range.last] &&
                             without_code(numbers_.labels[k]) == numbers_.labels[range.last];
        if (!follows) break;
        names.push_back(numbers_.labels[k]);
    }
    return names.empty() ? "" : listed_once(names);
}

Domain Numbering::range(Node const& node) const {
    std::array<ResidueName, 2> const ends = ends_of(node);
    if (!ends[0].chain.empty()) refuse_unknown_chain(node, ends[0].chain);
    Domain range{residue(node, ends[0]), residue(node, ends[1])};
    range.name = fmt::format("residues {} to {}", shown(ends[0].label), shown(ends[1].label));
    if (!ends[0].chain.empty()) range.name += " of chain " + shown(ends[0].chain);
    if (range.last < range.first) refuse_backwards(node, range);
    return range;
}

void Numbering::refuse_backwards(Node const& node, Domain const& range) const {
    std::string const low = numbers_.label(range.last), high = numbers_.label(range.first);
    std::string chain = node.kind == Node::Kind::scalar ? text(node) : "";
    chain = chain.substr(0, chain.rfind(':') == std::string::npos ? 0 : chain.rfind(':') + 1);
    fail(node, range.name + " run backwards",
         node.kind == Node::Kind::scalar
             ? fmt::format("write \"{}{}-{}\"", shown(without_blanks(chain)), low, high)
             : fmt::format("write [{}, {}]", low, high));
}

std::function<bool(std::string const&)> Numbering::chain_names() const {
    return [numbers = &numbers_](std::string const& name) {
        auto const& others = numbers->other_chains;
        return !name.empty() && (std::any_of(numbers->chains.begin(), numbers->chains.end(),
                                             [&](auto const& names) {
                                                 return names[0] == name || names[1] == name;
                                             }) ||
                                 std::find(others.begin(), others.end(), name) != others.end());
    };
}

bool Numbering::is_chain(std::string const& name) const {
    return std::any_of(numbers_.chains.begin(), numbers_.chains.end(),
                       [&](auto const& names) { return names[0] == name || names[1] == name; });
}

/// Throws InputError for a chain that the entry does not choose or the file does not have.
void Numbering::refuse_unknown_chain(Node const& node, std::string const& chain) const {
    if (numbers_.chains.empty() || is_chain(chain)) return;
    std::vector<std::string> names;
    for (auto const& [name, label] : numbers_.chains) names.push_back(name);
    std::string const chosen = listed_once(names);
    auto const& others = numbers_.other_chains;
    if (std::find(others.begin(), others.end(), chain) != others.end())
        fail(node, fmt::format("the entry does not choose chain {}", shown(chain)),
             fmt::format("name it under `chain`, as in `chain: [{}, {}]`, or use residues of {}",
                         chosen, shown(chain), chosen));
    names.insert(names.end(), others.begin(), others.end());
    fail(node, fmt::format("the file has no chain {}", shown(chain)),
         "take one of " + listed_once(names));
}

bool Numbering::is_list_of_ranges(Node const& node) {
    auto const is_range = [](Node const& item) {
        if (item.kind == Node::Kind::list || item.kind == Node::Kind::map) return true;
        return item.kind == Node::Kind::scalar && (item.text.find('-', 1) != std::string::npos ||
                                                   item.text.find(':') != std::string::npos);
    };
    return node.kind == Node::Kind::list &&
           std::any_of(node.items.begin(), node.items.end(), is_range);
}

std::array<ResidueName, 2> Numbering::ends_of(Node const& node) const {
    if (node.kind == Node::Kind::scalar) return ends_in(node);
    if (node.kind == Node::Kind::map) refuse_map(node, chain_names());
    bool const nests = std::any_of(node.items.begin(), node.items.end(), [](Node const& item) {
        return item.kind == Node::Kind::list || item.text.find('-', 1) != std::string::npos;
    });
    if (nests) refuse_depth(node, chain_names());
    if (node.kind != Node::Kind::list || node.items.size() != 2)
        fail(node, describe(node) + " is not a pair of residues", remedy());
    return {{{"", label(node.items[0])}, {"", label(node.items[1])}}};
}

/// Reads "A:1-95". Numbers may be negative: "A:-3-10".
std::array<ResidueName, 2> Numbering::ends_in(Node const& node) const {
    if (without_blanks(node.text).empty())
        fail(node, "an empty text is no range of residues", remedy());
    refuse_printed(node);
    refuse_several_ranges(node, chain_names());
    std::string const written = without_blanks(text(node));
    refuse_missing_colon(node, written);
    std::size_t const colon = written.rfind(':');
    std::string const chain =
        colon == std::string::npos ? "" : without_blanks(written.substr(0, colon));
    std::string const span =
        colon == std::string::npos ? written : without_blanks(written.substr(colon + 1));
    std::size_t const dash = span.find('-', 1);
    std::array<ResidueName, 2> ends{{{chain, without_blanks(span.substr(0, dash))}, {chain, ""}}};
    if (dash != std::string::npos) ends[1].label = without_blanks(span.substr(dash + 1));
    bool const two = !ends[1].label.empty() && ends[1].label.find('-', 1) == std::string::npos;
    if (std::string const likely = likely_range(written); !two && !likely.empty())
        fail(node, describe(node) + " is not a range of residues",
             fmt::format("did you mean \"{}\"?", shown(likely)));
    if (!two || colon == 0)
        fail(node, describe(node) + " is not a range of residues",
             numbers_.several_names()  ? remedy()
             : numbers_.labels.empty() ? "write \"FIRST-LAST\", such as \"1-95\", or [1, 95]"
                                       : "write CHAIN:FIRST-LAST, such as \"A:1-95\", or [1, 95]");
    return ends;
}

/// Throws InputError for "A1-72", "A 1-72" and "A;1-72", where A is a chain of the file. Names that
/// end in a digit could be the first digits of a number, unless something parts the two.
void Numbering::refuse_missing_colon(Node const& node, std::string const& written) const {
    if (written.find(':') != std::string::npos) return;
    std::size_t const dash = written.find('-', 1);
    if (residues_.contains(without_blanks(written.substr(0, dash)))) return;
    std::vector<std::string> names = numbers_.other_chains;
    for (auto const& [name, label] : numbers_.chains) names.insert(names.end(), {name, label});
    for (std::string const& name : names) {
        if (name.empty() || !written.starts_with(name) || written.size() == name.size()) continue;
        std::size_t const after = written.find_first_not_of(" \t;,./_|", name.size());
        if (after == std::string::npos) continue;
        std::string const rest = written.substr(after);
        bool const parted =
            after > name.size() || std::isdigit(static_cast<unsigned char>(name.back())) == 0;
        bool const numbered = std::isdigit(static_cast<unsigned char>(rest[0])) != 0 ||
                              (rest[0] == '-' && rest.find('-', 1) != std::string::npos);
        if (!parted || !numbered) continue;
        std::string const likely = likely_range(written);
        fail(node, describe(node) + " has no colon after the chain",
             fmt::format("did you mean \"{}\"?",
                         shown(likely.empty() ? name + ":" + rest : likely)));
    }
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
    if (found.empty()) {
        std::string const what =
            fmt::format("residue {}{} is not in the file", shown(end.label),
                        end.chain.empty() ? "" : " of chain " + shown(end.chain));
        std::string const alike = other_codes(end);
        if (!alike.empty())
            fail(node, what,
                 fmt::format("residues of that number have other insertion codes: write one of {}",
                             alike));
        fail(node, what, remedy(end.chain));
    }
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

/// Labels with the same number and another insertion code, joined by commas.
std::string Numbering::other_codes(ResidueName const& end) const {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < numbers_.labels.size(); ++k)
        if (in_chain(k, end.chain) && numbers_.labels[k] != end.label &&
            without_code(numbers_.labels[k]) == without_code(end.label))
            names.push_back(numbers_.labels[k]);
    return names.empty() ? "" : listed_once(names);
}

/// Residue of a number that counts residues from 1.
std::size_t Numbering::counted_residue(Node const& node, ResidueName const& end) const {
    if (!end.chain.empty())
        fail(node,
             fmt::format("chain {} is named, and the residues of this entry are counted from 1",
                         shown(end.chain)),
             numbers_.begins.empty()
                 ? "leave the chain out, or give the structure as `pdb`, whose chains and residue "
                   "numbers count"
                 : remedy());
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
    if (end.kind == Node::Kind::null) fail(end, "an end of the range is missing", remedy());
    if (numbers_.labels.empty()) return std::to_string(whole(end, 1));
    double value = 0;
    refuse_printed(end);
    std::string const written = text(end);
    return is_whole(written, value) ? std::to_string(static_cast<std::int64_t>(value)) : written;
}

}  // namespace catena::scene
