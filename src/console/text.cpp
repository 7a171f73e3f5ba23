// Implements tables and named values as text and HTML.
#include "console/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "page/html.hpp"

namespace catena::command {

std::string Table::text(std::string const& indent) const {
    std::vector<std::size_t> width;
    for (auto const& row : rows_) {
        width.resize(std::max(width.size(), row.size()));
        for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
    }
    std::string text;
    for (auto const& row : rows_) {
        std::string line = indent;
        for (std::size_t c = 0; c < row.size(); ++c) {
            line += (c == 0 ? "" : "  ") + (is_left(c) ? fmt::format("{:<{}}", row[c], width[c])
                                                       : fmt::format("{:>{}}", row[c], width[c]));
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string Table::html() const {
    std::string html = "<table class=\"rows\">\n<thead><tr>";
    for (std::string const& cell : rows_.front()) html += "<th>" + escaped(cell) + "</th>";
    html += "</tr></thead>\n<tbody>\n";
    for (std::size_t r = 1; r < rows_.size(); ++r) {
        html += "<tr>";
        for (std::size_t c = 0; c < rows_[r].size(); ++c)
            html += (is_left(c) ? "<td class=\"text\">" : "<td>") + escaped(rows_[r][c]) + "</td>";
        html += "</tr>\n";
    }
    return html + "</tbody>\n</table>\n";
}

bool Table::is_left(std::size_t column) const {
    return std::find(left_.begin(), left_.end(), column) != left_.end();
}

void Text::entry(std::string const& name, std::string const& value) {
    text_ += fmt::format("  {:<20} {}\n", name, value);
}

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds)) return "?";
    if (seconds >= 1) return fmt::format("{:.4g} s", seconds);
    if (seconds >= 1e-3) return fmt::format("{:.4g} ms", 1e3 * seconds);
    return fmt::format("{:.4g} us", 1e6 * seconds);
}

std::string bytes_text(double bytes) {
    if (bytes >= 1e9) return fmt::format("{:.4g} GB", 1e-9 * bytes);
    if (bytes >= 1e6) return fmt::format("{:.4g} MB", 1e-6 * bytes);
    return fmt::format("{:.4g} kB", 1e-3 * bytes);
}

std::string counted(long long n, std::string const& one, std::string const& many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

}  // namespace catena::command
