// Implements `catena bench figures`: the DCA chapter's table and figures on this machine.
#pragma once

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "measure/chapter_runs.hpp"

namespace catena::command {

/// Units of time, per second.
inline constexpr double microseconds = 1e6, milliseconds = 1e3;
/// Names that --figure accepts.
inline constexpr std::string_view figure_names[] = {"table-2.1", "2.3", "2.5", "2.6", "2.7"};

/// Measurements; a list is empty if its figure was not asked for.
struct Figures {
    /// Measurements of figure 2.3, by kind of handles.
    std::vector<LevelStudy> levels;
    /// Measurements of figures 2.5 to 2.7.
    std::vector<FigurePoint> points;
};
/// The quantity that figure 2.5, 2.6 or 2.7 shows, and its name in the chapter.
struct FigureQuantity {
    char const* figure;
    char const* title;
    /// Key in chapter_figures().
    char const* chapter;
};
inline constexpr FigureQuantity figure_quantities[] = {
    {"2.5", "a full step of RK4", "full_step"},
    {"2.6", "one solve", "solve"},
    {"2.7", "transfers of one solve", "transfer"}};
/// Returns the seconds of a figure's quantity; empty if the case does not measure it.
std::optional<Spread> quantity_of(FigurePoint const&, std::string const& figure);

/// Returns the figures among `asked` as SVG: pairs of file name and content.
std::vector<std::pair<std::string, std::string>> draw_figures(
    Figures const&, std::vector<std::string> const& asked);

/// Measures the figures of the request and writes them into its folder. Collective.
Outcome bench_figures(Communicator const&, BenchRequest const&);

}  // namespace catena::command
