// Implements the picture of one step's phases.
#include "page/timeline_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "page/axis.hpp"
#include "page/html.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;

// Sizes in pixels: picture, margins, lanes, bars, gap between ranks, time axis.
constexpr double width = 1160, left = 170, right = 14, lane_height = 26, bar_height = 19,
                 rank_gap = 10, axis_height = 40;
constexpr double character_width = 6.4;  // average width of the labels' characters, pixels
constexpr std::size_t most_ranks = 8, colours = 9,
                      idle_colour = 9;  // ranks drawn; classes of the page's style: bars, waiting

/// Phase of a step on one lane of a rank ("catena", "openmm"). Times in seconds.
struct Phase {
    std::string name, lane;
    double begin, end;
};

/// Recorded step of one rank, from its first phase to its last.
struct Step {
    std::int64_t number = 0;
    std::vector<Phase> phases;
    double begin = 0, end = 0;
};

/// Recorded steps of one rank.
struct Rank {
    std::int64_t number = 0;
    std::vector<Step> steps;
};

/// Reads a step. Throws nlohmann's exceptions for other contents.
Step read_step(Json const& json) {
    Step step;
    step.number = json.at("step").get<std::int64_t>();
    step.begin = std::numeric_limits<double>::infinity();
    step.end = -step.begin;
    for (Json const& entry : json.at("phases")) {
        Phase phase{entry.at("name").get<std::string>(), entry.at("lane").get<std::string>(),
                    entry.at("begin").get<double>(), entry.at("end").get<double>()};
        step.begin = std::min(step.begin, phase.begin);
        step.end = std::max(step.end, phase.end);
        step.phases.push_back(std::move(phase));
    }
    return step;
}

/// Reads all ranks. Steps without phases and ranks without steps are omitted.
std::vector<Rank> read_ranks(Json const& timeline) {
    std::vector<Rank> ranks;
    for (Json const& json : timeline.at("ranks")) {
        Rank rank;
        rank.number = json.at("rank").get<std::int64_t>();
        for (Json const& step : json.at("steps"))
            if (Step read = read_step(step); !read.phases.empty())
                rank.steps.push_back(std::move(read));
        if (!rank.steps.empty()) ranks.push_back(std::move(rank));
    }
    return ranks;
}

/// Returns the number of the step whose length is the median on this rank.
std::int64_t typical_step(Rank const& rank) {
    std::vector<std::pair<double, std::int64_t>> lengths;
    for (Step const& step : rank.steps) lengths.emplace_back(step.end - step.begin, step.number);
    auto const middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return middle->second;
}

/// Bars of one step: ranks one below the other, and the lanes of a rank one below the other.
class Picture {
    /// Selects the step on the first `most_ranks` ranks and fits the time axis to the longest of
    /// them.
  public:
    Picture(std::vector<Rank> const& ranks, std::int64_t step) : step_(step) {
        for (Rank const& rank : ranks)
            for (Step const& candidate : rank.steps)
                if (candidate.number == step && rows_.size() < most_ranks)
                    rows_.emplace_back(rank.number, &candidate);
        for (auto const& [rank, recorded] : rows_)
            length_ = std::max(length_, recorded->end - recorded->begin);
        // The axis is in s, ms or microseconds, by the longest rank.
        scale_ = length_ < 1e-3 ? 1e6 : length_ < 1 ? 1e3 : 1;
        axis_ = linear_axis(0, length_ * scale_, 0, 10);
    }

    /// Returns the SVG of axis and bars, followed by the legend.
    std::string draw() {
        std::string bars;
        double y = 6;
        for (auto const& [rank, recorded] : rows_) {
            bars += draw_rank(rank, *recorded, y);
            y += rank_gap;
        }
        std::string const unit = scale_ == 1 ? "s" : scale_ == 1e3 ? "ms" : "µs";
        std::string svg = fmt::format(
            "<svg viewBox=\"0 0 {} {:.0f}\" role=\"img\" aria-label=\"timeline of step {}\">\n",
            width, y + axis_height, step_);
        for (Axis::Tick const& tick : axis_.ticks) {
            double const x = at(tick.value);
            svg += fmt::format(
                "<line class=\"grid\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"4\" y2=\"{:.1f}\"/>", x, x,
                y);
            svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x,
                               y + 16, tick.label);
        }
        svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">time in {}{}</text>\n",
                           at(axis_.high / 2), y + 34, unit,
                           axis_.note.empty() ? "" : " " + axis_.note);
        return svg + bars + "</svg>\n" + legend();
    }

  private:
    /// Position in pixels of a time in units of the axis.
    double at(double value) const { return left + (width - left - right) * axis_.place(value); }

    /// Class of a phase's colour, in the order of first appearance. Waiting has a colour of its
    /// own.
    std::size_t colour_of(std::string const& name) {
        if (name.starts_with("wait")) return idle_colour;  // labelled in its bar
        auto const place = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) -
                                                    names_.begin());
        if (place == names_.size()) names_.push_back(name);
        return place % colours;
    }

    /// Bars of one rank, whose first phase starts at 0. Advances `y` by the lanes.
    std::string draw_rank(std::int64_t rank, Step const& step, double& y) {
        std::vector<std::string> lanes;
        for (Phase const& phase : step.phases)
            if (std::find(lanes.begin(), lanes.end(), phase.lane) == lanes.end())
                lanes.push_back(phase.lane);
        std::string svg = fmt::format(
            "<text class=\"strong\" x=\"4\" y=\"{:.1f}\">rank {}</text>\n", y + 14, rank);
        for (std::string const& lane : lanes) {
            svg += fmt::format("<text class=\"end\" x=\"{}\" y=\"{:.1f}\">{}</text>\n", left - 10,
                               y + 14, escaped(lane));
            for (Phase const& phase : step.phases)
                if (phase.lane == lane) svg += draw_bar(phase, step.begin, y);
            y += lane_height;
        }
        return svg;
    }

    /// Bar of a phase, with its name inside if there is room. `start`: time of the rank's first
    /// phase.
    std::string draw_bar(Phase const& phase, double start, double y) {
        double const from = at((phase.begin - start) * scale_),
                     wide = std::max(0.8, at((phase.end - start) * scale_) - from);
        std::string svg = fmt::format(
            "<rect class=\"c{}\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{}\" "
            "rx=\"2\"><title>{}: {:.4g} to "
            "{:.4g}</title></rect>",
            colour_of(phase.name), from, y, wide, bar_height, escaped(phase.name),
            (phase.begin - start) * scale_, (phase.end - start) * scale_);
        // The name is written only if the bar is wide enough.
        if (wide > character_width * static_cast<double>(phase.name.size()) + 8)
            svg += fmt::format("<text class=\"inside\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                               from + 5, y + 13.5, escaped(phase.name));
        return svg + "\n";
    }

    /// Names of the phases and their colours.
    std::string legend() const {
        std::string html = "<div class=\"legend\">";
        for (std::size_t k = 0; k < names_.size(); ++k)
            html += fmt::format("<span><i class=\"c{}\"></i>{}</span>", k % colours,
                                escaped(names_[k]));
        return html + "</div>\n";
    }

    std::int64_t step_;
    std::vector<std::pair<std::int64_t, Step const*>> rows_;  // drawn ranks and steps
    double length_ = 0, scale_ = 1;  // longest step, s; units of the axis per second
    Axis axis_;
    std::vector<std::string> names_;  // names of phases in the order of their colours
};

}  // namespace

/// A caption names the step, and says how many steps and ranks were recorded.
std::string timeline_picture(Json const& timeline) {
    std::vector<Rank> const ranks = read_ranks(timeline);
    if (ranks.empty()) return "";
    std::int64_t const step = typical_step(ranks.front());
    std::size_t const recorded = ranks.front().steps.size();
    std::string caption = fmt::format(
        "Step {}{}.", step,
        recorded > 1 ? fmt::format(", of median length among the {} recorded", recorded) : "");
    if (ranks.size() > most_ranks)
        caption += fmt::format(" The first {} of {} ranks.", most_ranks, ranks.size());
    return "<figure>\n" + Picture(ranks, step).draw() + "<figcaption>" + caption +
           "</figcaption>\n</figure>\n";
}

}  // namespace catena
