#include "io/summary_tables.hpp"

#include <fmt/format.h>

#include "io/html.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_entries = 8, most_rows = 40;

bool is_rows(Json const& value) {
    return value.is_array() && !value.empty() &&
           std::all_of(value.begin(), value.end(), [](Json const& entry) { return entry.is_object(); });
}

std::string cell(Json const& value) {
    if (value.is_string()) return escaped(value.get<std::string>());
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_null()) return "–";
    if (value.is_number_float()) return readable_number(value.get<double>());
    if (value.is_array()) {
        std::string text;
        for (std::size_t k = 0; k < std::min(value.size(), most_entries); ++k) text += (k == 0 ? "" : ", ") + cell(value[k]);
        return value.size() > most_entries ? text + fmt::format(", … ({} in all)", value.size()) : text;
    }
    return escaped(value.dump());
}

std::string row(std::string const& key, Json const& value) {
    return fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(readable_name(key)), cell(value));
}

std::string card(std::string const& title, std::string const& table) {
    return fmt::format("<section class=\"card\">\n<h3>{}</h3>\n{}</section>\n", escaped(readable_name(title)), table);
}

/// Columns are the keys of the first row.
std::string table_of_rows(Json const& rows) {
    std::string table = "<table class=\"rows\">\n<thead><tr>";
    for (auto const& column : rows[0].items()) table += "<th>" + escaped(readable_name(column.key())) + "</th>";
    table += "</tr></thead>\n<tbody>\n";
    for (std::size_t k = 0; k < std::min(rows.size(), most_rows); ++k) {
        table += "<tr>";
        for (auto const& column : rows[0].items())
            table += "<td>" + (rows[k].contains(column.key()) ? cell(rows[k][column.key()]) : "") + "</td>";
        table += "</tr>\n";
    }
    if (rows.size() > most_rows) table += fmt::format("<tr><td>… {} in all</td></tr>\n", rows.size());
    return table + "</tbody>\n</table>\n";
}

/// The object's own values in one card, then a card for everything nested in it.
std::string cards(std::string const& title, Json const& object) {
    std::string own, nested;
    for (auto const& [key, value] : object.items()) {
        std::string const full = title.empty() ? key : title + ": " + readable_name(key);
        if (value.is_object() && !value.empty())
            nested += cards(full, value);
        else if (is_rows(value))
            nested += card(full, table_of_rows(value));
        else
            own += row(key, value);
    }
    return (own.empty() ? "" : card(title.empty() ? "run" : title, "<table>\n" + own + "</table>\n")) + nested;
}

}  // namespace

std::string summary_tables(Json const& summary) { return "<div class=\"cards\">\n" + cards("", summary) + "</div>\n"; }

}  // namespace catena
