// Implements the layout of JSON for people: one key per line, plain lists on one line.
#include "console/outcome.hpp"

#include <algorithm>

namespace catena::command {
namespace {

/// Returns a value on one line; replaces invalid UTF-8.
std::string compact(Json const& value) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Appends a value, with nested objects and lists on indented lines.
void append(std::string& text, Json const& value, std::string const& indent) {
    bool const plain = std::none_of(value.begin(), value.end(), [](Json const& entry) {
        return entry.is_structured() && !entry.empty();
    });
    if (!value.is_structured() || value.empty() || (value.is_array() && plain)) {
        text += compact(value);
        return;
    }
    std::string const deeper = indent + "  ";
    text += value.is_object() ? "{" : "[";
    bool first = true;
    for (auto const& item : value.items()) {
        text += (first ? "\n" : ",\n") + deeper;
        if (value.is_object()) text += compact(item.key()) + ": ";
        append(text, item.value(), deeper);
        first = false;
    }
    text += "\n" + indent + (value.is_object() ? "}" : "]");
}

}  // namespace

std::string json_text(Json const& value) {
    std::string text;
    append(text, value, "");
    return text + "\n";
}

}  // namespace catena::command
