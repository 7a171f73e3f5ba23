// Implements the report of a run: report.html in the run's folder.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "error.hpp"
#include "io/observables_table.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"
#include "page/html.hpp"
#include "page/line_chart.hpp"
#include "page/summary_tables.hpp"
#include "page/timeline_picture.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Parses a JSON file. Throws InputError if it is not JSON.
Json read_json(fs::path const& file) {
    try {
        return Json::parse(read_text_file(file.string()));
    } catch (Json::exception const& error) {
        throw InputError("not JSON, " + std::string(error.what()), file.string(),
                         "correct or remove the file");
    }
}

/// Splits the name of a column: "total_energy [kJ/mol]" -> {"total_energy", "kJ/mol"}.
std::pair<std::string, std::string> name_and_unit(std::string const& column) {
    auto const open = column.find(" [");
    if (open == std::string::npos || column.back() != ']') return {column, ""};
    return {column.substr(0, open), column.substr(open + 2, column.size() - open - 3)};
}

/// Text with mean, standard deviation and last value. Values that are not finite are only counted.
std::string statistics(std::vector<double> const& values) {
    double sum = 0, squares = 0, count = 0;
    for (double const value : values)
        if (std::isfinite(value)) sum += value, ++count;
    double const mean = count > 0 ? sum / count : 0;
    for (double const value : values)
        if (std::isfinite(value)) squares += (value - mean) * (value - mean);
    std::string text =
        fmt::format("mean {}, standard deviation {}, last {}", readable_number(mean),
                    readable_number(count > 1 ? std::sqrt(squares / (count - 1)) : 0),
                    readable_number(values.back()));
    if (count < static_cast<double>(values.size()))
        text += fmt::format("; {} not finite", values.size() - static_cast<std::size_t>(count));
    return text;
}

/// True for a curve that would be a horizontal line, which conveys nothing.
bool is_constant(std::vector<double> const& values) {
    return values.size() > 1 && std::all_of(values.begin(), values.end(),
                                            [&](double value) { return value == values[0]; });
}

/// Charts of all observables against time. Constant observables are listed in one sentence.
std::string charts(ObservablesTable const& table) {
    if (table.columns[0].empty()) return "<p>No record was written.</p>\n";
    auto const [time, time_unit] = name_and_unit(table.names[1]);
    std::string const time_label =
        time_unit.empty() ? time : fmt::format("{} / {}", time, time_unit);
    std::string html = "<div class=\"charts\">\n", constant;
    for (std::size_t k = 2; k < table.names.size(); ++k) {
        auto const [name, unit] = name_and_unit(table.names[k]);
        if (is_constant(table.columns[k])) {
            constant += fmt::format("{}{}: {} {}", constant.empty() ? "" : ", ",
                                    escaped(readable_name(name)),
                                    readable_number(table.columns[k][0]), escaped(unit));
            continue;
        }
        Curve const curve{time_label, unit == "1" ? "" : unit, table.columns[1], table.columns[k]};
        html += fmt::format("<figure>\n<h3>{}</h3>\n{}<figcaption>{}</figcaption>\n</figure>\n",
                            escaped(readable_name(name)), line_chart(curve),
                            statistics(table.columns[k]));
    }
    return html + "</div>\n" + (constant.empty() ? "" : "<p>Constant: " + constant + ".</p>\n");
}

/// Table of the known files in the folder, with links and explanations.
std::string files_in(fs::path const& folder) {
    static constexpr std::pair<char const*, char const*> known[] = {
        {"trajectory.h5md", "trajectory (H5MD 1.1)"},
        {"topology.pdb", "topology for the trajectory"},
        {"topology.cif", "topology for the trajectory"},
        {"observables.csv", "observables"},
        {"checkpoint.h5", "checkpoint for --restart"},
        {"checkpoint.previous.h5", "the checkpoint before"},
        {"summary.json", "the numbers above"},
        {"timeline.json", "phases of recorded steps"},
        {"picture.png", "observables and conformation"}};
    std::string rows;
    for (auto const& [name, use] : known)
        if (fs::exists(folder / name))
            rows += fmt::format("<tr><th><a href=\"{}\"><code>{}</code></a></th><td>{}</td></tr>\n",
                                name, name, use);
    return rows.empty() ? ""
                        : "<h2>Files</h2>\n<section class=\"card files\">\n<table>\n" + rows +
                              "</table>\n</section>\n";
}

/// Picture of one step's phases; empty if the timeline is. Throws InputError for other contents.
std::string timeline_section(fs::path const& file) {
    try {
        std::string const picture = timeline_picture(read_json(file));
        return picture.empty() ? "" : "<h2>One step</h2>\n" + picture;
    } catch (Json::exception const& error) {
        throw InputError("not a timeline, " + std::string(error.what()), file.string(),
                         "correct or remove the file");
    }
}

/// Title of the scene, else the scene's file, else the name of the folder.
std::string title_of(Json const& summary, fs::path const& folder) {
    for (char const* key : {"title", "scene"})
        if (summary.contains(key) && summary[key].is_string() &&
            !summary[key].get<std::string>().empty())
            return summary[key].get<std::string>();
    return fs::absolute(folder).lexically_normal().filename().string();
}

}  // namespace

/// Throws InputError if the folder holds no file of a run, or one that is damaged.
void write_run_report(std::string const& folder) {
    // Every file is optional, but not all of them.
    fs::path const in(folder), summary_file = in / "summary.json",
                               observables = in / "observables.csv",
                               timeline = in / "timeline.json";
    if (!fs::exists(summary_file) && !fs::exists(observables) && !fs::exists(timeline))
        throw InputError("nothing to report", folder, "name the folder of a run");
    Json summary = fs::exists(summary_file) ? read_json(summary_file) : Json::object();
    if (!summary.is_object())
        throw InputError("not an object", summary_file.string(), "correct or remove the file");
    // Sections of the page: title, summary, observables, one step, files.
    std::string const title = title_of(summary, in);
    std::string body = fmt::format("<h1>{}</h1>\n<p>A run of Catena</p>\n", escaped(title));
    summary.erase("files");  // files are listed with links at the end
    if (!summary.empty()) body += "<h2>Summary</h2>\n" + summary_tables(summary);
    if (fs::exists(observables))
        body += "<h2>Observables</h2>\n" + charts(read_observables(observables.string()));
    if (fs::exists(timeline)) body += timeline_section(timeline);
    body += files_in(in);
    replace_text_file((in / "report.html").string(), html_page(title + " – Catena", body));
}

}  // namespace catena
