// `catena bench figures`: the founding chapter's table and figures.
#pragma once

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "measure/chapter_runs.hpp"

namespace catena::command {

inline constexpr std::string_view figure_names[] = {"table-2.1", "2.3", "2.5", "2.6", "2.7"};

/// What was measured; empty where a figure was not asked for.
struct Figures {
    std::vector<LevelStudy> levels;   // 2.3, by kind of handles
    std::vector<FigurePoint> points;  // 2.5 to 2.7
};
/// One of "2.5", "2.6", "2.7": the quantity it shows of a point, and the chapter's name for it.
struct FigureQuantity {
    char const* figure;
    char const* title;
    char const* chapter;  // in chapter_figures()
};
inline constexpr FigureQuantity figure_quantities[] = {
    {"2.5", "a full step of RK4", "full_step"},
    {"2.6", "one solve", "solve"},
    {"2.7", "transfers of one solve", "transfer"}};
/// Seconds; nothing where the case has none.
std::optional<Spread> quantity_of(FigurePoint const&, std::string const& figure);

/// SVG files, name and content, of the figures among `asked`.
std::vector<std::pair<std::string, std::string>> draw_figures(
    Figures const&, std::vector<std::string> const& asked);

Outcome bench_figures(Communicator const&, BenchRequest const&);

}  // namespace catena::command
