// Text from outside as it may be shown: on a terminal, in a page, in a table.
#pragma once

#include <string>
#include <string_view>

namespace catena {

/// The text as valid UTF-8 without control characters: bytes that are not UTF-8 become U+FFFD,
/// control characters (C0 but for the line's end and the tabulator, DEL, C1, and the marks of
/// Unicode that end or turn around lines) become `?`.
std::string printable(std::string_view text);

}  // namespace catena
