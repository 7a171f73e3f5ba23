// Escaped text, readable names and numbers, and the frame and style of every page.
#pragma once

#include <string>
#include <string_view>

namespace catena {

/// Returns printable text with the characters &, <, > and " replaced by HTML's entities.
std::string escaped(std::string_view text);

/// Returns a key as a name: "total_energy" -> "Total energy".
std::string readable_name(std::string_view key);

/// Returns a key as words within a sentence: "total_energy" -> "total energy".
std::string readable_words(std::string_view key);

/// Returns a number of six significant digits without trailing zeros.
std::string readable_number(double value);

/// Returns a complete page that loads nothing else, with a light and a dark style.
std::string html_page(std::string const& title, std::string const& body);

}  // namespace catena
