// Implements the tables, the JSON and the files of `catena bench figures`.
#include "report/figures.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "console/text.hpp"
#include "io/output.hpp"
#include "measure/hardware.hpp"
#include "measure/operation_counts.hpp"
#include "mpi/first_rank.hpp"
#include "report/chapter_figures.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

/// Formats a measured number; "-" if it is missing.
std::string number(std::optional<double> const& value) {
    if (value && !std::isfinite(*value)) return "not resolved";
    return value ? fmt::format("{:.3g}", *value) : "-";
}
char const* verdict(bool valid) { return valid ? "VALID" : "INVALID"; }

/// Converts counts of floating-point operations to JSON.
Json json_of(Operations const& o) {
    return {{"additions", o.additions}, {"multiplications", o.multiplications}, {"fused", o.fused},
            {"divisions", o.divisions}, {"square_roots", o.square_roots},       {"sum", o.sum()}};
}
/// Converts the counts of one kind of handles to JSON.
Json json_of(HandleOperations const& h) {
    return {{"directions", h.directions},
            {"assembly",
             {{"matrices", json_of(h.assembly_matrices)}, {"biases", json_of(h.assembly_biases)}}},
            {"disassembly", json_of(h.disassembly)},
            {"leaf",
             {{"matrices", json_of(h.leaf_matrices)},
              {"biases", json_of(h.leaf_biases)},
              {"accelerations", json_of(h.leaf_accelerations)}}}};
}
/// Converts a spread of times to JSON; null if it is missing.
Json json_of(std::optional<Spread> const& s) {
    if (!s) return nullptr;
    return {{"median", s->median}, {"min", s->min}, {"max", s->max}};
}

/// Adds Table 2.1: the lowest levels' share of the merges, and the operations per merge and body.
void add_table(Outcome& outcome) {
    std::int64_t constexpr bodies = 2048;
    std::vector<std::int64_t> const merges = merges_of_levels(bodies);
    auto const all = std::accumulate(merges.begin(), merges.end(), std::int64_t{0});
    Table levels({"levels", "kernel operations", "chapter", "% of a solve", "chapter"});
    Json& json = outcome.json["table_2.1"] = {
        {"bodies", bodies}, {"levels", Json::array()}, {"operations", Json::array()}};
    std::int64_t below = 0;
    for (std::size_t l = 0; l < chapter_levels.size(); ++l) {
        below += merges[l];
        double const percent = 100.0 * static_cast<double>(below) / static_cast<double>(all);
        ChapterLevel const& chapter = chapter_levels[l];
        levels.add({chapter.level, std::to_string(below), std::to_string(chapter.operations),
                    fmt::format("{:.1f}", percent), std::to_string(chapter.percent)});
        json["levels"].push_back({{"levels", chapter.level},
                                  {"kernel_operations", below},
                                  {"chapter_kernel_operations", chapter.operations},
                                  {"percent", percent},
                                  {"chapter_percent", chapter.percent}});
    }
    outcome.text +=
        fmt::format("Table 2.1: merges of the lowest levels, {} bodies\n", bodies) + levels.text();
    Table operations({"joint", "directions", "assembly", "disassembly", "leaf", "full: directions",
                      "assembly", "disassembly", "leaf", "assembly, full over projected"});
    for (JointOperations const& joint : count_operations()) {
        HandleOperations const &p = joint.projected, &f = joint.full;
        operations.add({joint.joint, std::to_string(p.directions), std::to_string(p.assembly()),
                        std::to_string(p.disassembly.sum()), std::to_string(p.leaf()),
                        std::to_string(f.directions), std::to_string(f.assembly()),
                        std::to_string(f.disassembly.sum()), std::to_string(f.leaf()),
                        fmt::format("{:.3g}", static_cast<double>(f.assembly()) /
                                                  static_cast<double>(p.assembly()))});
        json["operations"].push_back(
            {{"joint", joint.joint}, {"projected", json_of(p)}, {"full", json_of(f)}});
    }
    outcome.text +=
        "Floating-point operations per merge and per body (a fused multiply-add counts twice), "
        "with projected and then with full handles\n" +
        operations.text();
}

/// Converts the times of a level to JSON.
Json json_of(LevelSeconds const& s) {
    return {{"assembly", s.assembly}, {"disassembly", s.disassembly}};
}

/// Returns "CPU" or "GPU", the cheaper place for a level; "-" if there is no comparison.
char const* cheapest_place(LevelPoint const& p) {
    double cpu = p.one_core.assembly;
    if (p.threads) cpu = std::min(cpu, p.threads->assembly);
    bool const known = p.gpu && std::isfinite(p.gpu->assembly) &&
                       std::isfinite(p.one_core.assembly) &&
                       (!p.threads || std::isfinite(p.threads->assembly));
    return !known ? "-" : p.gpu->assembly < cpu ? "GPU" : "CPU";
}

/// Number of the levels' times, and number of those that noise hides.
struct Resolved {
    int all = 0, missing = 0;
    void add(LevelSeconds const& s) {
        for (double const value : {s.assembly, s.disassembly})
            ++all, missing += std::isfinite(value) ? 0 : 1;
    }
};
/// Counts the times of all studies.
Resolved resolved(std::vector<LevelStudy> const& studies) {
    Resolved count;
    for (LevelStudy const& study : studies)
        for (LevelPoint const& p : study.levels) {
            count.add(p.one_core);
            for (auto const* more : {&p.threads, &p.gpu})
                if (*more) count.add(**more);
        }
    return count;
}
/// Returns a remark on times that noise hides; empty if there are none.
std::string resolution_text(std::vector<LevelStudy> const& studies) {
    Resolved const count = resolved(studies);
    if (count.missing == 0) return "";
    return fmt::format(
        "; figure 2.3: {} of {} times are below the noise (raise --repeat, or measure on an idle "
        "machine)",
        count.missing, count.all);
}

/// Adds the table and the JSON of figure 2.3 for one kind of handles.
void add_levels(Outcome& outcome, LevelStudy const& study) {
    Table table({"level", "merges", "one core", "threads", "GPU", "transfers", "cheapest",
                 "one core", "threads", "GPU"},
                {0, 6});
    Json levels = Json::array();
    for (LevelPoint const& p : study.levels) {
        auto const us = [](double seconds) { return number(microseconds * seconds); };
        auto const part = [&](std::optional<LevelSeconds> const& s, double LevelSeconds::* what) {
            return s ? us((*s).*what) : "-";
        };
        table.add({std::to_string(p.level), std::to_string(p.merges), us(p.one_core.assembly),
                   part(p.threads, &LevelSeconds::assembly), part(p.gpu, &LevelSeconds::assembly),
                   p.transfers ? us(*p.transfers) : "-", cheapest_place(p),
                   us(p.one_core.disassembly), part(p.threads, &LevelSeconds::disassembly),
                   part(p.gpu, &LevelSeconds::disassembly)});
        levels.push_back(
            {{"level", p.level},
             {"merges", p.merges},
             {"one_core", json_of(p.one_core)},
             {"threads", p.threads ? json_of(*p.threads) : Json(nullptr)},
             {"gpu", p.gpu ? json_of(*p.gpu) : Json(nullptr)},
             {"transfers_cut_above", p.transfers ? Json(*p.transfers) : Json(nullptr)}});
    }
    outcome.valid = outcome.valid && study.valid();
    outcome.text += fmt::format(
        "Figure 2.3: each level of the tree, {} bodies, {} handles, {} threads; microseconds: "
        "assembly, transfers of a tree cut above the "
        "level, the cheapest place, disassembly. Level 1 includes the bodies. Residual {:.1e}, "
        "bound {:.1e}, {}\n",
        study.bodies, name_of(study.handles), study.threads, study.residual, study.residual_bound,
        verdict(study.valid()));
    outcome.text += table.text();
    outcome.json["figure_2.3"].push_back({{"bodies", study.bodies},
                                          {"handles", name_of(study.handles)},
                                          {"threads", study.threads},
                                          {"levels", levels},
                                          {"residual", study.residual},
                                          {"residual_bound", study.residual_bound},
                                          {"valid", study.valid()}});
}

/// Adds the JSON of all points of figures 2.5 to 2.7.
void add_points(Outcome& outcome, std::vector<FigurePoint> const& points) {
    outcome.json["points"] = Json::array();
    for (FigurePoint const& p : points) {
        outcome.valid = outcome.valid && p.valid();
        outcome.json["points"].push_back(
            {{"bodies", p.bodies},
             {"handles", name_of(p.handles)},
             {"case", p.what.name},
             {"backend", name_of(p.what.backend)},
             {"gpu_levels",
              p.what.backend == Backend::cuda_levels ? Json(p.what.gpu_levels) : Json(nullptr)},
             {"threads", p.threads},
             {"repeat", p.step.count},
             {"full_step", json_of(p.step)},
             {"solve", json_of(p.solve)},
             {"upload", json_of(p.upload)},
             {"download", json_of(p.download)},
             {"levels_on_gpu", json_of(p.lower)},
             {"levels_on_host", json_of(p.upper)},
             {"residual", p.residual},
             {"residual_bound", p.residual_bound},
             {"valid", p.valid()}});
    }
}

/// Adds the table of a figure. A row per number of bodies shows the measured cases, the largest of
/// their residuals, and the chapter's values if it has any.
void add_quantity(Outcome& outcome, std::vector<FigurePoint> const& points,
                  FigureQuantity const& quantity, Handles handles) {
    std::vector<std::string> names;
    std::map<std::int64_t, std::map<std::string, FigurePoint const*>> rows;
    for (FigurePoint const& p : points) {
        if (p.handles != handles || !quantity_of(p, quantity.figure)) continue;
        if (std::find(names.begin(), names.end(), p.what.name) == names.end())
            names.push_back(p.what.name);
        rows[p.bodies][p.what.name] = &p;
    }
    if (names.empty()) {
        outcome.text +=
            fmt::format("Figure {}: {}, {} handles: left out, no case here times its transfers\n",
                        quantity.figure, quantity.title, name_of(handles));
        return;
    }
    std::vector<std::string> header{"bodies"};
    header.insert(header.end(), names.begin(), names.end());
    header.insert(header.end(), {"residual/bound", ""});
    for (std::string const& column : chapter_columns) header.push_back("ch. " + column);
    Table table(header, {0, names.size() + 2});
    auto const& chapter = chapter_figures().at(quantity.chapter);
    for (auto const& [bodies, row] : rows) {
        std::vector<std::string> cells{std::to_string(bodies)};
        double worst = 0;
        bool valid = true;
        for (std::string const& name : names) {
            FigurePoint const& p = *row.at(name);
            cells.push_back(number(milliseconds * quantity_of(p, quantity.figure)->median));
            worst = larger(worst, p.residual / p.residual_bound);
            valid = valid && p.valid();
        }
        cells.insert(cells.end(), {fmt::format("{:.1e}", worst), verdict(valid)});
        auto const found = chapter.find(bodies);
        for (std::size_t i = 0; i < chapter_columns.size(); ++i)
            cells.push_back(found == chapter.end() ? "" : number(found->second[i]));
        table.add(cells);
    }
    outcome.text += fmt::format("Figure {}: {}, {} handles; milliseconds\n", quantity.figure,
                                quantity.title, name_of(handles)) +
                    table.text();
}

/// Creates the output folder. Throws InputError if that fails. Collective.
void make_folder(Communicator const& communicator, std::string const& folder) {
    on_first_rank(communicator, [&] {
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error || !std::filesystem::is_directory(folder, error))
            throw InputError("the folder cannot be created: " + error.message(),
                             "--output " + folder, "name another folder");
    });
}

/// True if the request asks for the figure.
bool wants(BenchRequest const& request, std::string_view figure) {
    return std::find(request.figures.begin(), request.figures.end(), figure) !=
           request.figures.end();
}

/// Returns the kinds of handles that are measured: both, or that of --handles.
std::vector<Handles> handles_of(BenchRequest const& request) {
    if (request.handles.empty()) return {Handles::full, Handles::projected};
    return {request.handles == "full" ? Handles::full : Handles::projected};
}

/// Returns the number of --threads; 0 if it was not given.
int threads_of(BenchRequest const& request) {
    return request.threads.empty() ? 0 : std::stoi(request.threads);
}

/// Measures figure 2.3 on the largest chain.
std::vector<LevelStudy> measure_all_levels(Communicator const& communicator,
                                           BenchRequest const& request) {
    std::vector<LevelStudy> levels;
    std::int64_t const largest = *std::max_element(request.sizes.begin(), request.sizes.end());
    int const threads = threads_of(request);
    for (Handles const kind : handles_of(request))
        levels.push_back(measure_levels(
            kind, largest, threads > 0 ? threads : cores_of_rank(communicator), request.repeat));
    return levels;
}

/// Measures the points of figures 2.5 to 2.7. Collective.
std::vector<FigurePoint> measure_all_steps(Communicator const& communicator,
                                           BenchRequest const& request,
                                           std::vector<FigureCase> const& cases) {
    std::vector<FigurePoint> all;
    for (Handles const kind : handles_of(request))
        for (std::int64_t const bodies : request.sizes) {
            auto const points = measure_steps(cases, kind, bodies, threads_of(request),
                                              request.repeat, communicator);
            all.insert(all.end(), points.begin(), points.end());
            spdlog::info("{} bodies, {} handles: measured", bodies, name_of(kind));
        }
    return all;
}

/// Measures what the request asks for; adds to `left_out` what cannot be measured here. Collective.
Figures measure(Communicator const& communicator, BenchRequest const& request,
                std::vector<std::string>& left_out) {
    std::vector<FigureCase> const cases = figure_cases(left_out);
    if (cases.back().backend == Backend::cuda)
        left_out.emplace_back("cuda in figure 2.7: its transfers are not timed separately");
    Figures figures;
    if (wants(request, "2.3") && communicator.size() == 1)
        figures.levels = measure_all_levels(communicator, request);
    else if (wants(request, "2.3"))
        left_out.emplace_back("figure 2.3: levels are timed on one rank");
    if (wants(request, "2.5") || wants(request, "2.6") || wants(request, "2.7"))
        figures.points = measure_all_steps(communicator, request, cases);
    return figures;
}

/// Adds what was measured, and on what.
void add_circumstances(Outcome& outcome, Communicator const& communicator,
                       BenchRequest const& request, std::vector<std::string> const& left_out) {
    outcome.json = {{"bench", "figures"},
                    {"build", version_json()},
                    {"hardware", hardware_json()},
                    {"ranks", communicator.size()},
                    {"case",
                     "the chapter's pendulum at rest, one step of RK4 of 1e-4 s; medians, seconds; "
                     "of a solve: both sweeps, transfers included"},
                    {"left_out", left_out}};
    outcome.text =
        fmt::format("medians of {}, cases in turn. {}, {}; {}, {}. ch.: the chapter, {}\n",
                    request.repeat, counted(communicator.size(), "rank", "ranks"), hardware_text(),
                    compiler_name(), instruction_set(), chapter_hardware);
}

/// Returns the chapter's own numbers.
Json chapter_json() {
    Json chapter = Json::object();
    for (auto const& [figure, rows] : chapter_figures())
        for (auto const& [bodies, row] : rows)
            chapter[figure].push_back({bodies, row[0], row[1], row[2], row[3], row[4], row[5]});
    return {{"hardware", chapter_hardware},
            {"columns", {"bodies", "serial", "openmp", "gpu1", "gpu3", "gpu6", "gpu_all"}},
            {"milliseconds", chapter}};
}

/// Writes figures.json and the pictures into the folder, and names them in the text.
void write_files(Outcome& outcome, std::string const& folder, Figures const& figures,
                 BenchRequest const& request) {
    write_text_file(folder + "/figures.json", json_text(outcome.json));
    outcome.text += "wrote " + folder + "/figures.json";
    for (auto const& [name, svg] : draw_figures(figures, request.figures)) {
        write_text_file(fmt::format("{}/{}", folder, name), svg);
        outcome.text += ", " + name;
    }
    outcome.text +=
        fmt::format("\n{}{}\n", verdict(outcome.valid), resolution_text(figures.levels));
}

}  // namespace

Outcome bench_figures(Communicator const& communicator, BenchRequest const& request) {
    std::string const folder = request.output.empty() ? "catena-figures" : request.output;
    make_folder(communicator, folder);
    std::vector<std::string> left_out;
    Figures const figures = measure(communicator, request, left_out);
    Outcome outcome;
    add_circumstances(outcome, communicator, request, left_out);
    if (wants(request, "table-2.1")) add_table(outcome);
    for (LevelStudy const& study : figures.levels) add_levels(outcome, study);
    add_points(outcome, figures.points);
    for (FigureQuantity const& quantity : figure_quantities)
        for (Handles const kind : handles_of(request))
            if (wants(request, quantity.figure))
                add_quantity(outcome, figures.points, quantity, kind);
    for (std::string const& line : left_out) outcome.text += "left out: " + line + "\n";
    outcome.json["chapter"] = chapter_json();
    outcome.json["valid"] = outcome.valid;
    outcome.json["not_resolved"] = resolved(figures.levels).missing;
    outcome.complaint = "a residual above its bound: see the results";
    on_first_rank(communicator, [&] { write_files(outcome, folder, figures, request); });
    return outcome;
}

}  // namespace catena::command
