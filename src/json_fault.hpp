// Text on a fault of a JSON file, in place of the library's own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace catena {

/// Returns where a parser of JSON stopped: "not well-formed JSON, line 3" or, for a position in a
/// very long line, "not well-formed JSON, line 1, character 5000". A text that ends too early is
/// said to be cut. `byte` counts from 1, as nlohmann::json::parse_error does.
inline std::string json_fault(std::string_view text, std::size_t byte) {
    std::size_t constexpr longest_plain_line = 200;  // in which the number of the line is enough
    std::string_view const before = text.substr(0, byte == 0 ? 0 : byte - 1);
    std::size_t const begin = before.rfind('\n') + 1;  // 0 without a line feed
    std::string fault = "not well-formed JSON, line " +
                        std::to_string(1 + std::count(before.begin(), before.end(), '\n'));
    if (before.size() - begin > longest_plain_line)
        fault += ", character " + std::to_string(before.size() - begin + 1);
    bool const ended =
        text.substr(std::min(before.size(), text.size())).find_first_not_of(" \t\r\n") ==
        std::string_view::npos;
    return ended ? fault + ": the text ends too early, as in a file that was cut" : fault;
}

}  // namespace catena
