// Implements the tables of summary.json.
#include "page/summary_tables.hpp"

#include <fmt/format.h>

#include "page/html.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;

// Limits of what is shown: entries of a list, rows of a table, columns of a table in a card,
// characters of a value next to its name.
constexpr std::size_t most_entries = 8, most_rows = 40, most_columns = 4, longest_cell = 40;

/// True for a list of objects, which becomes a table of rows.
bool is_rows(Json const& value) {
    return value.is_array() && !value.empty() &&
           std::all_of(value.begin(), value.end(),
                       [](Json const& entry) { return entry.is_object(); });
}

/// HTML of one value. Long lists are abbreviated.
std::string cell(Json const& value) {
    if (value.is_string()) return escaped(value.get<std::string>());
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_null()) return "–";
    if (value.is_number_float()) return readable_number(value.get<double>());
    if (value.is_array()) {
        std::string text;
        for (std::size_t k = 0; k < std::min(value.size(), most_entries); ++k)
            text += (k == 0 ? "" : ", ") + cell(value[k]);
        return value.size() > most_entries ? text + fmt::format(", … ({} in all)", value.size())
                                           : text;
    }
    return escaped(value.dump());
}

/// True for values that are not shown.
bool is_empty(Json const& value) {
    return value.is_null() || (value.is_string() && value.get<std::string>().empty()) ||
           ((value.is_array() || value.is_object()) && value.empty());
}

/// Row with a name and its value.
std::string row(std::string const& key, Json const& value) {
    std::string const name = escaped(readable_name(key)), text = cell(value);
    // Long values, such as sentences, use the whole width below their name.
    if (text.size() > longest_cell)
        return fmt::format("<tr><td colspan=\"2\" class=\"text\"><span>{}</span> {}</td></tr>\n",
                           name, text);
    return fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", name, text);
}

/// Table of a list of objects. Its columns are the keys of the first object.
std::string table_of_rows(Json const& rows) {
    std::string table = "<table class=\"rows\">\n<thead><tr>";
    for (auto const& column : rows[0].items())
        table += "<th>" + escaped(readable_name(column.key())) + "</th>";
    table += "</tr></thead>\n<tbody>\n";
    for (std::size_t k = 0; k < std::min(rows.size(), most_rows); ++k) {
        table += "<tr>";
        for (auto const& column : rows[0].items())
            table += "<td>" + (rows[k].contains(column.key()) ? cell(rows[k][column.key()]) : "") +
                     "</td>";
        table += "</tr>\n";
    }
    if (rows.size() > most_rows)
        table += fmt::format("<tr><td>… {} in all</td></tr>\n", rows.size());
    return table + "</tbody>\n</table>\n";
}

/// Cards with the values of each object, and tables of many columns below all cards.
struct Sections {
    std::string cards, wide;

    /// Card of a title and a table.
    static std::string card(std::string const& title, std::string const& table) {
        return fmt::format("<section class=\"card\">\n<h3>{}</h3>\n{}</section>\n",
                           escaped(readable_name(title)), table);
    }

    /// Adds the values of an object as one card, then its objects and lists one after the other.
    void add(std::string const& title, Json const& object) {
        // Plain values are added first, so that they form one card.
        std::string own;
        for (auto const& [key, value] : object.items())
            if (!is_empty(value) && !value.is_object() && !is_rows(value)) own += row(key, value);
        if (!own.empty())
            cards += card(title.empty() ? "overview" : title, "<table>\n" + own + "</table>\n");
        // Nested objects follow; a list of one object counts as that object.
        for (auto const& [key, value] : object.items()) {
            std::string const full =
                title.empty() ? key : fmt::format("{}: {}", title, readable_name(key));
            if (value.is_object())
                add(full, value);
            else if (is_rows(value) && value.size() == 1)
                add(full, value[0]);
            else if (is_rows(value))
                (value[0].size() > most_columns ? wide : cards) += card(full, table_of_rows(value));
        }
    }
};

}  // namespace

/// The values of the top level form the card "overview".
std::string summary_tables(Json const& summary) {
    Sections sections;
    sections.add("", summary);
    return "<div class=\"cards\">\n" + sections.cards + "</div>\n" + sections.wide;
}

}  // namespace catena
