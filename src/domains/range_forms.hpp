// Slips in the form of residue ranges, told by what was meant.
#pragma once

#include <functional>
#include <string>

#include "scene/node.hpp"
#include "scene/text_lines.hpp"

namespace catena::scene {

/// True for the name of a chain. A name may look like a range, "1-2".
using IsChain = std::function<bool(std::string const&)>;

/// True for a map that holds ranges, which YAML makes of `A: 1-72` and `1-72: 77-148` without
/// quotes.
bool is_map_of_ranges(Node const& node, IsChain const&);

/// Throws InputError for a map where a range should be, and writes its entries as ranges.
[[noreturn]] void refuse_map(Node const& node, IsChain const&);

/// Throws InputError for a `rigid` that is not a list, or a list of numbers, and writes it as a
/// list of ranges.
void refuse_no_list(Node const& rigid, IsChain const&);

/// Throws InputError for ranges in more brackets than a body of several ranges has.
void refuse_depth(Node const& node, IsChain const&);

/// Throws InputError for a text that holds several ranges, such as "A:1-72, A:80-90".
void refuse_several_ranges(Node const& node, IsChain const&);

/// Throws InputError for a text with an en dash, an em dash or a minus sign in place of the hyphen,
/// as papers print ranges, or with a non-breaking space.
void refuse_printed(Node const& node);

/// Returns the range that a text of another form most likely means: "A:1-72" for "A1-A72", "A:1 to
/// 72" and "A:1..72"; empty if none is likely.
std::string likely_range(std::string const& written);

/// Returns the text without blanks at its ends.
inline std::string without_blanks(std::string const& text) { return std::string(trimmed(text)); }

}  // namespace catena::scene
