// Implements the text and the page of a report.
#include "report/report_part.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "page/html.hpp"

namespace catena::command {

ReportSection& ReportPart::section(std::string const& heading, Table const& empty) {
    auto const found = std::find_if(sections.begin(), sections.end(),
                                    [&](ReportSection const& s) { return s.heading == heading; });
    return found != sections.end() ? *found
                                   : sections.emplace_back(ReportSection{heading, empty, {}});
}

std::string text_of(ReportPart const& part) {
    std::string text = part.title + "\n" + part.note + "\n";
    for (ReportSection const& section : part.sections)
        text += section.heading + "\n" + section.table.text();
    return text;
}

std::string page_of(std::string const& title, std::string const& subtitle,
                    std::vector<ReportPart> const& parts) {
    std::string body = fmt::format("<h1>{}</h1>\n<p>{}</p>\n", escaped(title), escaped(subtitle));
    for (ReportPart const& part : parts) {
        body += fmt::format("<h2>{}</h2>\n<p>{}</p>\n", escaped(part.title), escaped(part.note));
        for (ReportSection const& section : part.sections) {
            if (!section.pictures.empty()) body += "<div class=\"charts\">\n";
            for (CurveFamily const& picture : section.pictures)
                body += "<figure>\n" + curve_family(picture) + "</figure>\n";
            if (!section.pictures.empty()) body += "</div>\n";
            body += fmt::format("<section class=\"card\">\n<h3>{}</h3>\n{}</section>\n",
                                escaped(section.heading), section.table.html());
        }
    }
    return html_page(title, body);
}

Json spread_json(Spread const& s) {
    return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"repeat", s.count}};
}

std::string exponent(double value) { return fmt::format("{:.1e}", value); }

}  // namespace catena::command
