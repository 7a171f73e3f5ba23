// External text made safe to be shown on a terminal, in a page or in a table.
#pragma once

#include <string>
#include <string_view>

namespace catena {

/// Returns the text as valid UTF-8 without control characters. Bytes that are not UTF-8 become
/// U+FFFD. Control characters become `?`: C0 except line feed and tab, DEL, C1, and Unicode's line
/// separators and direction marks.
std::string printable(std::string_view text);

}  // namespace catena
