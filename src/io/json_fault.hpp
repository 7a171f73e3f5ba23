// Text on a fault of a JSON file, in place of the library's own.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace catena {

/// Returns where a parser of JSON stopped: "not well-formed JSON, line 3" or, for a position in a
/// very long line, "not well-formed JSON, line 1, character 5000". A text that ends too early is
/// said to be cut. `byte` counts from 1, as nlohmann::json::parse_error does.
std::string json_fault(std::string_view text, std::size_t byte);

}  // namespace catena
