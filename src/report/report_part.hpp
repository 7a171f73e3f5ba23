// What a report is made of: parts with sections, each a table with its pictures; printed, written
// as JSON and laid out as a page.
#pragma once

#include <string>
#include <vector>

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "measure/timing.hpp"
#include "page/curve_family.hpp"

namespace catena::command {

struct ReportSection {
    std::string heading;
    Table table;
    std::vector<CurveFamily> pictures;  // on the page alone
};
struct ReportPart {
    std::string key,
        picture;  // in the JSON, and of the picture that a script draws (without .png; empty: none)
    std::string title;
    std::string note;  // what the numbers mean
    std::vector<ReportSection> sections;
    Json json;
    bool valid = true;

    /// Made at the end where there is none of that heading.
    ReportSection& section(std::string const& heading, Table const& empty);
};

std::string text_of(ReportPart const&);
/// Self-contained; `subtitle`: hardware and build.
std::string page_of(std::string const& title, std::string const& subtitle,
                    std::vector<ReportPart> const&);

Json spread_json(Spread const&);
/// "1.2e-15"
std::string exponent(double value);

}  // namespace catena::command
