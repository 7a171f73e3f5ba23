// Implements the text on faults of JSON files.
#include "io/json_fault.hpp"

#include <algorithm>

namespace catena {
namespace {

/// Longest line in which the number of the line is enough.
constexpr std::size_t longest_plain_line = 200;

}  // namespace

std::string json_fault(std::string_view text, std::size_t byte) {
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
