// Implements the report of a run: report.html in the run's folder.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "error.hpp"
#include "io/observables_table.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"
#include "json_fault.hpp"
#include "page/html.hpp"
#include "page/line_chart.hpp"
#include "page/observable_statistics.hpp"
#include "page/run_facts.hpp"
#include "page/summary_tables.hpp"
#include "page/timeline_picture.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Parses a JSON file. Throws InputError if it is not JSON.
Json read_json(fs::path const& file) {
    std::string const text = read_text_file(file.string());
    try {
        return Json::parse(text);
    } catch (Json::parse_error const& error) {
        throw InputError(json_fault(text, error.byte), file.string(), "correct or remove the file");
    } catch (Json::exception const&) {  // the only one that parsing throws besides
        throw InputError("a number beyond double precision", file.string(),
                         "correct or remove the file");
    }
}

/// Label of an axis: "time / ps", "total energy / (kJ/mol)".
std::string axis_label(std::string const& name, std::string const& unit) {
    if (unit.empty() || unit == "1") return readable_words(name);
    bool const compound = unit.find('/') != std::string::npos;
    return readable_words(name) + (compound ? " / (" + unit + ")" : " / " + unit);
}

/// Text with the standard deviation of the frames that count and the last value. Values that are
/// not finite are only counted.
std::string spread_text(std::vector<double> const& values, std::size_t left_out) {
    double sum = 0, squares = 0, count = 0, others = 0;
    for (std::size_t i = left_out; i < values.size(); ++i)
        std::isfinite(values[i]) ? (sum += values[i], ++count) : ++others;
    double const mean = count > 0 ? sum / count : 0;
    for (std::size_t i = left_out; i < values.size(); ++i)
        if (std::isfinite(values[i])) squares += (values[i] - mean) * (values[i] - mean);
    std::string text =
        fmt::format("standard deviation {}, last {}",
                    readable_number(count > 1 ? std::sqrt(squares / (count - 1)) : 0),
                    readable_number(values.back()));
    if (others > 0) text += fmt::format("; {:.0f} not finite", others);
    return text;
}

/// True for a curve that would be a horizontal line, which conveys nothing.
bool is_constant(std::vector<double> const& values) {
    return values.size() > 1 && std::all_of(values.begin(), values.end(),
                                            [&](double value) { return value == values[0]; });
}

/// Number of first frames that are taken for equilibration.
std::size_t frames_left_out(Json const& summary) {
    auto const found = summary.find("equilibration");
    return found == summary.end() ? 0 : found->value("frames_left_out", std::size_t{0});
}

/// Charts of all observables against time. The range of frames that do not count is shaded.
/// Constant observables are listed in one sentence.
std::string charts(ObservablesTable const& table, std::size_t left_out) {
    if (table.columns[0].empty()) return "<p>No record was written.</p>\n";
    auto const [time, time_unit] = name_and_unit(table.names[1]);
    left_out = std::min(left_out, table.columns[0].size() - 1);
    double const counts_from = left_out > 0 ? table.columns[1][left_out] : -INFINITY;
    std::string html = "<div class=\"charts\">\n", constant;
    for (std::size_t k = 2; k < table.names.size(); ++k) {
        auto const [name, unit] = name_and_unit(table.names[k]);
        if (is_constant(table.columns[k])) {
            constant += fmt::format("{}{}: {} {}", constant.empty() ? "" : ", ",
                                    escaped(readable_name(name)),
                                    readable_number(table.columns[k][0]), escaped(unit));
            continue;
        }
        Curve const curve{axis_label(time, time_unit), axis_label(name, unit), table.columns[1],
                          table.columns[k], counts_from};
        html += fmt::format("<figure>\n<h3>{}</h3>\n{}<figcaption>{}</figcaption>\n</figure>\n",
                            escaped(readable_name(name)), line_chart(curve),
                            spread_text(table.columns[k], left_out));
    }
    return html + "</div>\n" + (constant.empty() ? "" : "<p>Constant: " + constant + ".</p>\n");
}

/// Section of named lines; empty if there are none.
std::string facts_section(std::string const& title, std::vector<Fact> const& facts) {
    std::string rows;
    for (Fact const& fact : facts)
        rows += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(readable_name(fact.name)),
                            escaped(fact.value));
    return rows.empty() ? ""
                        : fmt::format(
                              "<h2>{}</h2>\n<section class=\"card facts\">\n<table>\n{}"
                              "</table>\n</section>\n",
                              title, rows);
}

/// Table of means with their standard errors; empty if there are none.
std::string table_of_means(Json const& summary) {
    std::string rows;
    for (ObservableRow const& each : observable_rows(summary))
        rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                            escaped(readable_name(each.name)), each.mean, each.standard_error,
                            escaped(each.unit));
    if (rows.empty()) return "";
    return "<section class=\"card\">\n<table class=\"rows\">\n<thead><tr><th>Observable</th>"
           "<th>Mean</th><th>Standard error</th><th>Unit</th></tr></thead>\n<tbody>\n" +
           rows + "</tbody>\n</table>\n</section>\n<p>" + escaped(equilibration_sentence(summary)) +
           "</p>\n";
}

/// Section of all observables: means and charts.
std::string observables_section(Json const& summary, std::optional<ObservablesTable> const& table) {
    if (!table) return "";
    return "<h2>Observables</h2>\n" + table_of_means(summary) +
           charts(*table, frames_left_out(summary));
}

/// Section with the verdict and its reason; empty for a summary without one.
std::string verdict_section(Json const& summary) {
    auto const valid = summary.find("valid");
    if (valid == summary.end() || !valid->is_boolean()) return "";
    return fmt::format("<h2>Verdict</h2>\n<p class=\"verdict\">{}</p>\n<p>{}</p>\n",
                       valid->get<bool>() ? "VALID" : "INVALID", escaped(verdict_reason(summary)));
}

/// Section of the run's notes; empty if there are none.
std::string notes_section(Json const& summary) {
    std::string items;
    if (auto const notes = summary.find("notes"); notes != summary.end() && notes->is_array())
        for (Json const& note : *notes)
            items += "<li>" + escaped(note.get<std::string>()) + "</li>\n";
    return items.empty() ? "" : "<h2>Notes</h2>\n<ul>\n" + items + "</ul>\n";
}

/// Folded section of everything else in the summary, and of the timeline.
std::string internals_section(Json summary, std::string const& timeline) {
    for (char const* const shown : {"title", "units", "system", "observables", "equilibration",
                                    "last_observables", "notes", "files"})
        summary.erase(shown);
    std::string const tables = summary.empty() ? "" : summary_tables(summary);
    if (tables.empty() && timeline.empty()) return "";
    return "<details>\n<summary>Solver, forces and ranks</summary>\n" + tables + timeline +
           "</details>\n";
}

/// Table of the known files in the folder, with links and explanations.
std::string files_in(fs::path const& folder) {
    static constexpr std::pair<char const*, char const*> known[] = {
        {"trajectory.h5md", "trajectory (H5MD 1.1)"},
        {"topology.pdb", "topology for the trajectory"},
        {"topology.cif", "topology for the trajectory"},
        {"observables.csv", "observables"},
        {"replicas.csv", "observables of each replica"},
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
    } catch (Json::exception const&) {
        throw InputError("not a timeline of a run", file.string(), "correct or remove the file");
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
    std::optional<ObservablesTable> table;
    if (fs::exists(observables)) table = read_observables(observables.string());
    if (table && !summary.contains("observables"))
        summary.update(json_of(statistics_of(*table, Frames::all)));
    std::string const title = title_of(summary, in),
                      picture = fs::exists(timeline) ? timeline_section(timeline) : "";
    std::string body = fmt::format("<h1>{}</h1>\n<p>A run of Catena</p>\n", escaped(title));
    try {
        body += facts_section("What was simulated", system_facts(summary)) +
                observables_section(summary, table) + facts_section("Speed", speed_facts(summary)) +
                verdict_section(summary) + notes_section(summary) +
                internals_section(summary, picture);
    } catch (Json::exception const&) {
        throw InputError("not the summary of a run", summary_file.string(),
                         "correct or remove the file");
    }
    body += files_in(in);
    replace_text_file((in / "report.html").string(), html_page(title + " – Catena", body));
}

}  // namespace catena
