#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "error.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"
#include "page/axis.hpp"
#include "page/curve_family.hpp"
#include "page/html.hpp"
#include "page/line_chart.hpp"
#include "page/timeline_picture.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

std::vector<std::string> labels_of(Axis const& axis) {
    std::vector<std::string> labels;
    for (Axis::Tick const& tick : axis.ticks) labels.push_back(tick.label);
    return labels;
}

std::size_t count(std::string const& text, std::string const& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

std::size_t points_in(std::string const& svg) {
    auto const begin = svg.find("points=\"");
    return count(svg.substr(begin, svg.find("\"/>", begin) - begin), ",");
}

TEST(Axis, TicksAreRoundNumbersWithinTheRange) {
    EXPECT_EQ(labels_of(linear_axis(0, 10, 0, 5)),
              (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
    EXPECT_EQ(labels_of(linear_axis(-0.3, 0.3, 0, 6)),
              (std::vector<std::string>{"-0.3", "-0.2", "-0.1", "0.0", "0.1", "0.2", "0.3"}));
    Axis const constant = linear_axis(5, 5, 0, 5);
    EXPECT_GT(constant.ticks.size(), 1U);
    EXPECT_NEAR(constant.place(5), 0.5, 1e-12);
}

TEST(Axis, PowersAndOffsetsStandOnce) {
    Axis const small = linear_axis(0, 3e-12, 0, 3);
    EXPECT_EQ(small.note, "× 10⁻¹²");
    EXPECT_EQ(labels_of(small), (std::vector<std::string>{"0", "1", "2", "3"}));
    Axis const drift = linear_axis(-1234.567801, -1234.567800, 0, 4);
    EXPECT_NE(drift.note.find("− 1234.5678"), std::string::npos) << drift.note;
    for (std::string const& label : labels_of(drift)) EXPECT_LE(label.size(), 6U) << label;
}

TEST(Axis, AnythingFiniteIsDrawn) {
    for (double const low : {0.0, -1e300, 1e-300, 1.0, -5e15})
        for (double const range : {0.0, 1e-320, 1e-9, 1.0, 1e300}) {
            Axis const axis = linear_axis(low, low + range, 0.05, 5);
            EXPECT_TRUE(std::isfinite(axis.place(low)) && axis.place(low) >= 0 &&
                        axis.place(low) <= 1)
                << low << " " << range;
            EXPECT_LT(axis.ticks.size(), 30U);
        }
}

TEST(LineChart, DrawsAtMostTwoThousandPointsAndLosesNoSpike) {
    Curve curve{"time / ps", "K", {}, {}};
    for (int k = 0; k < 123457; ++k) {
        curve.x.push_back(k);
        curve.y.push_back(std::sin(1e-3 * k));
    }
    curve.y[77777] = 5;
    std::string const svg = line_chart(curve);
    EXPECT_LE(points_in(svg), 2000U);
    EXPECT_GT(points_in(svg), 1900U);
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < curve.x.size(); ++k) points.emplace_back(curve.x[k], curve.y[k]);
    auto const kept = thinned(points, 1000);
    EXPECT_NE(std::find(kept.begin(), kept.end(), std::pair(77777.0, 5.0)), kept.end());
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(),
                               [](auto const& a, auto const& b) { return a.first < b.first; }));
}

TEST(LineChart, FewOddOrNoPointsAreFine) {
    double const nan = std::nan("");
    EXPECT_EQ(points_in(line_chart({"t", "", {0, 1, 2}, {1, nan, 3}})), 2U);
    EXPECT_EQ(count(line_chart({"t", "", {0}, {1}}), "<circle"), 1U);
    EXPECT_EQ(line_chart({"t", "", {0}, {nan}}), "<p>No finite values.</p>\n");
    EXPECT_EQ(line_chart({"t", "", {0, 1}, {1, 1}}).find("nan"), std::string::npos);
    EXPECT_NE(line_chart({"t", "", {0, 1}, {1e-12, 1e-6}}).find(">10⁻⁶<"), std::string::npos)
        << "six decades ask for a logarithm";
}

TEST(CurveFamily, AValueThatIsNotResolvedIsAGapWithACross) {
    CurveFamily const family{
        "t", "x", "y", {{"a", {1, 2, 4, 8, 16}, {1, 2, std::nan(""), 3, 4}, false, true}}};
    std::string const svg = curve_family(family);
    EXPECT_EQ(count(svg, "<polyline"), 2U);
    EXPECT_EQ(count(svg, "not resolved"), 1U);
    EXPECT_EQ(count(svg, "<path fill=\"#"), 5U) << "four points, and one in the legend";
}

TEST(CurveFamily, NoTwoOfManyCurvesLookAlike) {
    CurveFamily family{"t", "x", "y", {}};
    for (int k = 0; k < 20; ++k)
        family.curves.push_back({"a" + std::to_string(k), {1, 2}, {1, 2}, false, true});
    std::string const svg = curve_family(family);
    std::set<std::string> looks;
    for (auto at = svg.find("<path fill"); at != std::string::npos;
         at = svg.find("<path fill", at + 1)) {
        std::string const mark = svg.substr(at, svg.find("/>", at) - at);
        looks.insert(mark.substr(0, mark.find("transform")) + mark.substr(mark.find(" d=")));
    }
    EXPECT_EQ(looks.size(), 20U);
}

TEST(Html, WhatIsNoUtf8OrAControlCharacterIsReplaced) {
    EXPECT_EQ(escaped("a\xE9<\x1b[31m"), "a\xEF\xBF\xBD&lt;?[31m");
    EXPECT_EQ(escaped("\xC2\x9B\xED\xA0\x80\xC0\x80"),
              "?" + std::string("\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD"));
    EXPECT_EQ(escaped("µ – \n\t"), "µ – \n\t");
}

void write_folder(TemporaryFolder const& folder) {
    write_text_file(
        folder / "summary.json",
        R"({"title": "a <b> & \"c\"", "steps": 1000, "valid": true, "rate": {"steps_per_second": 1234.5678, "ns_per_day": 0.1},
                        "phases": [{"name": "forces", "seconds": 1.5}, {"name": "matrices", "seconds": 0.25}], "none": null,
                        "files": {"a": "b"}, "single": [{"depth": 12}], "wide": [{"a": 1, "b": 2, "c": 3, "d": 4, "e": 5}, {"a": 6}],
                        "story": "a sentence that is longer than the forty characters of a cell"})");
    ObservablesWriter table(folder / "observables.csv",
                            {"total_energy [kJ/mol]", "temperature [K]", "still [nm]", "ratio [1]"},
                            {});
    for (int k = 0; k < 50; ++k) table.write(k, 0.01 * k, {std::cos(k), 300.0 + k, 1, 0.01 * k});
    table.close();
    write_text_file(folder / "timeline.json",
                    R"({"ranks": [{"rank": 0, "steps": [
                        {"step": 1, "phases": [{"name": "forces", "lane": "openmm worker", "begin": 10.0, "end": 10.9}]},
                        {"step": 2, "phases": [{"name": "forces", "lane": "openmm worker", "begin": 10.0, "end": 10.00050},
                                               {"name": "matrices", "lane": "main", "begin": 10.0001, "end": 10.00030}]},
                        {"step": 3, "phases": [{"name": "forces", "lane": "openmm worker", "begin": 10.0, "end": 10.00001}]}]},
                      {"rank": 1, "steps": [{"step": 2, "phases": [{"name": "biases", "lane": "main", "begin": 7, "end": 7.0002}]}]}]})");
}

TEST(RunReport, IsOneSelfContainedPage) {
    TemporaryFolder const folder;
    write_folder(folder);
    write_run_report(folder.path());
    std::string const page = read_text_file(folder / "report.html");
    EXPECT_EQ(page.find("://"), std::string::npos) << "something is fetched from the network";
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_NE(page.find("<h1>a &lt;b&gt; &amp; &quot;c&quot;</h1>"), std::string::npos);
    EXPECT_EQ(count(page, "<polyline"), 3U) << "one curve an observable";
    EXPECT_NE(page.find("Constant: Still: 1 nm.<"), std::string::npos);
    EXPECT_NE(page.find("<h3>Total energy</h3>"), std::string::npos);
    EXPECT_NE(page.find("<p>All 50 frames count.</p>"), std::string::npos);
    EXPECT_EQ(page.find("class=\"shade\""), std::string::npos) << "nothing is left out";
    EXPECT_NE(page.find(">time / ps<"), std::string::npos);
    EXPECT_NE(page.find("<tr><th>Steps per second</th><td>1234.57</td></tr>"), std::string::npos);
    EXPECT_NE(page.find("<h3>Rate</h3>"), std::string::npos);
    EXPECT_NE(page.find("<tr><td>matrices</td><td>0.25</td></tr>"), std::string::npos);
    EXPECT_EQ(page.find("<th>None</th>"), std::string::npos) << "nothing to tell";
    EXPECT_NE(page.find("<h3>Single</h3>\n<table>\n<tr><th>Depth</th><td>12</td></tr>"),
              std::string::npos);
    EXPECT_GT(page.find("<h3>Wide</h3>"), page.find("<h3>Single</h3>"));
    EXPECT_NE(page.find("<span>Story</span> a sentence"), std::string::npos);
    EXPECT_NE(page.find("href=\"observables.csv\""), std::string::npos);
    EXPECT_EQ(page.find("href=\"trajectory.h5md\""), std::string::npos)
        << "a file that is not there";
}

/// Positions of the texts in the page, in the order of their first occurrence.
void expect_in_order(std::string const& page, std::vector<std::string> const& texts) {
    std::size_t at = 0;
    for (std::string const& text : texts) {
        std::size_t const found = page.find(text, at);
        ASSERT_NE(found, std::string::npos) << text;
        at = found;
    }
}

TEST(RunReport, BeginsWithTheScienceAndFoldsTheSolver) {
    TemporaryFolder const folder;
    write_folder(folder);
    write_text_file(folder / "summary.json", R"x({
            "title": "two chains",
            "units": {"length": "nm", "time": "ps"},
            "system": {"description": "2 chains of 10 beads (a, b)"},
            "run": {"integrator": "g-baoab", "step": 0.01},
            "observables": {"total_energy": {"mean": 1.25, "standard_error": 0.125, "unit": "kJ/mol",
                                             "samples": 40, "converged": true}},
            "equilibration": {"frames": 50, "frames_left_out": 10,
                              "description": "The first 10 of 50 frames are left out."},
            "speed": {"ns_per_day": 12},
            "valid": false,
            "verdict": {"valid": false,
                        "checks": [{"name": "joints", "passed": false, "value": 1, "limit": 0.1, "step": 7,
                                    "advice": "too <long>"}]},
            "notes": ["a note"],
            "solver": {"backend": "serial"}
        })x");
    write_run_report(folder.path());
    std::string const page = read_text_file(folder / "report.html");
    expect_in_order(
        page,
        {"<h1>two chains</h1>", "What was simulated", "2 chains of 10 beads (a, b)",
         "g-baoab, step 0.01 ps", "<h2>Observables</h2>",
         "<tr><td>Total energy</td><td>1.25</td><td>0.12</td><td>kJ/mol</td></tr>",
         "The first 10 of 50 frames are left out.", "total energy / (kJ/mol)<", "<h2>Speed</h2>",
         "12 ns", ">INVALID<", "joints at step 7: too &lt;long&gt;", "<li>a note</li>", "<details>",
         "<td>serial</td>", "<h2>One step</h2>", "</details>", "<h2>Files</h2>"});
    EXPECT_EQ(count(page, "class=\"shade\""), 3U) << "equilibration of every curve";
}

TEST(RunReport, DrawsTheStepOfMedianLength) {
    TemporaryFolder const folder;
    write_folder(folder);
    std::string const picture =
        timeline_picture(nlohmann::ordered_json::parse(read_text_file(folder / "timeline.json")));
    EXPECT_NE(picture.find("Step 2, of median length among the 3 recorded."), std::string::npos)
        << picture;
    EXPECT_EQ(count(picture, "<rect"), 3U);
    EXPECT_NE(picture.find("<title>matrices: 100 to 300</title>"), std::string::npos) << picture;
    EXPECT_NE(picture.find("time in µs"), std::string::npos);
    EXPECT_NE(picture.find(">rank 1<"), std::string::npos);
}

TEST(RunReport, WhatIsMissingIsLeftOutAndWhatIsBrokenIsNamed) {
    TemporaryFolder const folder;
    EXPECT_THROW(write_run_report(folder.path()), InputError);
    write_text_file(folder / "summary.json", "{}");
    write_run_report(folder.path());
    write_text_file(folder / "timeline.json", R"({"ranks": []})");
    write_run_report(folder.path());
    EXPECT_EQ(read_text_file(folder / "report.html").find("<svg"), std::string::npos);
    write_text_file(folder / "timeline.json", R"({"ranks": [{"rank": 0}]})");
    EXPECT_NE(message_of([&] { write_run_report(folder.path()); }).find("not a timeline"),
              std::string::npos);
    write_text_file(folder / "summary.json", "{");
    EXPECT_NE(message_of([&] {
                  write_run_report(folder.path());
              }).find("(" + (folder / "summary.json") + ")"),
              std::string::npos);
}

}  // namespace
}  // namespace catena::test
