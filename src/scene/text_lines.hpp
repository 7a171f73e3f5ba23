// Lines and cells of text files, without the blanks around them.
#pragma once

#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace catena::scene {

/// Characters that separate words and lines.
inline constexpr std::string_view blanks = " \t\r\n";

/// Returns the text without blanks, tabs and line ends at either side. It refers to `text`.
inline std::string_view trimmed(std::string_view text) {
    std::size_t const first = text.find_first_not_of(blanks);
    return first == std::string_view::npos
               ? std::string_view()
               : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Splits the text into trimmed lines with their numbers from 1. Text from `comment` on is dropped,
/// unless it is 0. Blank lines are left out.
inline std::vector<std::pair<int, std::string>> lines_of(std::string const& text, char comment) {
    std::vector<std::pair<int, std::string>> lines;
    std::istringstream stream(text);
    std::string line;
    for (int n = 1; std::getline(stream, line); ++n) {
        std::string_view const kept =
            trimmed(comment ? std::string_view(line).substr(0, line.find(comment)) : line);
        if (!kept.empty()) lines.emplace_back(n, kept);
    }
    return lines;
}

/// Splits a line at its commas and trims the cells. A comma at the end begins an empty cell.
inline std::vector<std::string> cells_of(std::string const& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line + ",");
    for (std::string cell; std::getline(stream, cell, ',');) cells.emplace_back(trimmed(cell));
    return cells;
}

}  // namespace catena::scene
