// The structure of a report: parts with sections, each with a table and pictures. A report is
// printed, written as JSON and laid out as a page.
#pragma once

#include <string>
#include <vector>

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "measure/timing.hpp"
#include "page/curve_family.hpp"

namespace catena::command {

/// A table with its heading and pictures.
struct ReportSection {
    std::string heading;
    Table table;
    /// Pictures; shown on the page only.
    std::vector<CurveFamily> pictures;
};
/// A part of a report with its own verdict.
struct ReportPart {
    /// Key in the JSON, and name of the picture that a script draws (without .png; empty for none).
    std::string key, picture;
    std::string title;
    /// Explains what the numbers mean.
    std::string note;
    std::vector<ReportSection> sections;
    Json json;
    bool valid = true;

    /// Returns the section with this heading. Adds a section with the table `empty` if there is
    /// none.
    ReportSection& section(std::string const& heading, Table const& empty);
};

/// Returns the part as text: title, note, and all tables.
std::string text_of(ReportPart const&);
/// Returns a self-contained HTML page. `subtitle` names hardware and build.
std::string page_of(std::string const& title, std::string const& subtitle,
                    std::vector<ReportPart> const&);

/// Converts a spread of times to JSON.
Json spread_json(Spread const&);
/// Returns for example "1.2e-15".
std::string exponent(double value);

}  // namespace catena::command
