// Slips in the form of residue ranges, told by what was meant.
#pragma once

#include <string>

#include "scene/node.hpp"
#include "scene/text_lines.hpp"

namespace catena::scene {

/// True for a map whose values are ranges, which YAML makes of `A: 1-72` without quotes.
bool is_map_of_ranges(Node const& node);

/// Throws InputError for a map where a range should be, and writes its entries as ranges.
[[noreturn]] void refuse_map(Node const& node);

/// Throws InputError for a text that holds several ranges, such as "A:1-72, A:80-90".
void refuse_several_ranges(Node const& node);

/// Throws InputError for a text with an en dash, an em dash or a minus sign in place of the hyphen,
/// as papers print ranges.
void refuse_printed_dash(Node const& node);

/// Returns the text without blanks at its ends.
inline std::string without_blanks(std::string const& text) { return std::string(trimmed(text)); }

}  // namespace catena::scene
