// `catena analyse`: the text and JSON of an analysis.
#include "analysis/analysis.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "command/commands.hpp"
#include "console/picture.hpp"
#include "console/text.hpp"
#include "io/output_file.hpp"
#include "mpi/first_rank.hpp"

namespace catena::command {
namespace {

using analysis::Analysis;
using analysis::Estimate;

constexpr std::size_t most_named_kinds = 6;  // kinds named in one line

std::string output_folder(AnalyseRequest const& request) {
    if (!request.output.empty()) return request.output;
    std::filesystem::path folder = request.folder;
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) folder = folder.parent_path();
    return (folder / "analysis").string();
}

std::string number(double value, char const* mark = "") {
    return std::isfinite(value) ? fmt::format("{:.5g}{}", value, mark) : "-";
}

std::string kinds_text(Analysis const& a) {
    std::string text;
    for (std::size_t k = 0; k < a.kinds.size() && k < most_named_kinds; ++k)
        text += fmt::format("{}{} x {} of {}", k > 0 ? ", " : "", a.kinds[k].copies(),
                            a.kinds[k].name, counted(a.kinds[k].sites, "site", "sites"));
    if (a.kinds.size() > most_named_kinds)
        text += fmt::format(" and {} more kinds", a.kinds.size() - most_named_kinds);
    return text;
}

std::string text_of(Analysis const& a) {
    Text text;
    text.heading(a.title.empty() ? a.trajectory : a.title);
    text.entry("trajectory", a.trajectory);
    text.entry("frames", fmt::format("{} of {}, steps {} to {}, {:.6g} to {:.6g} {}",
                                     a.steps.size(), a.frames_in_file, a.steps.front(),
                                     a.steps.back(), a.times.front(), a.times.back(), a.time_unit));
    text.entry("chains", kinds_text(a));
    Table table({"quantity", "chains", "value", "error", "between copies", "unit", "how"},
                {0, 1, 5, 6});
    bool may_grow = false;
    for (analysis::Quantity const& q : a.quantities) {
        bool const open = std::isfinite(q.value.error) && q.value.error > 0 && !q.value.plateau;
        may_grow = may_grow || open;
        table.add({q.name, q.kind, number(q.value.mean), number(q.value.error, open ? "*" : ""),
                   number(q.value.between), q.unit, q.basis});
    }
    text.add(table);
    if (may_grow)
        text.note("*: the error by blocking may still grow with longer blocks: sample longer");
    for (std::string const& note : a.notes) text.note(note);
    return text.str();
}

Json json_of(Estimate const& e) {
    return {{"value", e.mean},
            {"error_by_blocking", e.error},
            {"error_between_copies", e.between},
            {"plateau", e.plateau}};
}

Json json_of(analysis::Curve const& curve) {
    Json json{{"name", curve.name},         {"chains", curve.kind},
              {"variable", curve.variable}, {"variable_unit", curve.variable_unit},
              {"unit", curve.unit},         {"x", curve.x}};
    for (auto const& [key, member] : {std::pair{"value", &Estimate::mean},
                                      {"error_by_blocking", &Estimate::error},
                                      {"error_between_copies", &Estimate::between}}) {
        std::vector<double> values;
        for (Estimate const& e : curve.y) values.push_back(e.*member);
        json[key] = values;
    }
    return json;
}

Json json_of(Analysis const& a) {
    Json kinds = Json::array(), quantities = Json::array(), curves = Json::array();
    for (analysis::Kind const& kind : a.kinds)
        kinds.push_back({{"name", kind.name},
                         {"sites", kind.sites},
                         {"copies", kind.copies()},
                         {"ring", kind.ring}});
    for (analysis::Quantity const& q : a.quantities) {
        Json one{{"name", q.name}, {"chains", q.kind}, {"unit", q.unit}, {"basis", q.basis}};
        one.update(json_of(q.value));
        quantities.push_back(std::move(one));
    }
    for (analysis::Curve const& curve : a.curves) curves.push_back(json_of(curve));
    return {{"trajectory", a.trajectory},
            {"title", a.title},
            {"frames_in_file", a.frames_in_file},
            {"first_frame", a.first_frame},
            {"frames", a.steps.size()},
            {"first_step", a.steps.front()},
            {"last_step", a.steps.back()},
            {"first_time", a.times.front()},
            {"last_time", a.times.back()},
            {"time_unit", a.time_unit},
            {"contact_cutoff", a.cutoff},
            {"chains", kinds},
            {"quantities", quantities},
            {"curves", curves},
            {"notes", a.notes}};
}

/// Returns a note if the run's own means leave out frames at the start that this analysis counts.
std::string equilibration_note(Analysis const& a) {
    std::ifstream file(std::filesystem::path(a.trajectory).replace_filename("summary.json"));
    Json const summary = Json::parse(file, nullptr, false);
    Json::json_pointer const frames("/equilibration/frames"),
        left_out("/equilibration/frames_left_out");
    if (summary.is_discarded() || !summary.contains(frames) || !summary.contains(left_out))
        return "";
    Json const& out = summary[left_out];
    if (a.first_frame > 0 || summary[frames] != a.frames_in_file || !out.is_number_unsigned() ||
        out == 0)
        return "";
    return fmt::format(
        "all frames count here; the run's own means leave out the first {} as equilibration, as "
        "--first {} would",
        out.get<std::size_t>(), out.get<std::size_t>());
}

}  // namespace

Outcome analyse_run(Communicator const& communicator, AnalyseRequest const& request) {
    Outcome outcome;
    on_first_rank(communicator, [&] {
        TrajectoryFile const trajectory(request.folder,
                                        request.members ? SiteOrder::members : SiteOrder::stored);
        Analysis found = analysis::analyse(trajectory, request.options);
        if (std::string note = equilibration_note(found); !note.empty())
            found.notes.push_back(std::move(note));
        std::string const folder = output_folder(request);
        make_output_folder(folder);
        std::vector<std::string> const files = analysis::write_tables(found, folder);
        outcome.text = text_of(found);
        outcome.json = json_of(found);
        outcome.json["files"] = files;
        Text written;
        for (std::size_t i = 0; i < files.size(); ++i)
            written.entry(i == 0 ? "files" : "", files[i]);
        std::string const remark = draw_analysis(folder);
        written.note(remark.empty() ? "drew " + folder + "/analysis.png" : remark);
        outcome.text += written.str();
    });
    return outcome;
}

}  // namespace catena::command
