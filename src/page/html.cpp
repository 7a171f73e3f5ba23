// Implements HTML text, and the style of all pages.
#include "page/html.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/printable.hpp"

namespace catena {
namespace {

// Style sheet of every page. The classes c0 to c8 are the colours of bars, c9 that of waiting.
constexpr std::string_view style = R"css(
:root { color-scheme: light dark;
  --page: #f6f7f9; --card: #ffffff; --ink: #1b2733; --soft: #5b6b7b; --rule: #dfe4ea; --grid: #e9edf1; --line: #0b6bcb; --link: #0b6bcb; }
@media (prefers-color-scheme: dark) { :root {
  --page: #11161c; --card: #1a2129; --ink: #e4e9ee; --soft: #9aa8b5; --rule: #303a45; --grid: #29323c; --line: #5db0ff; --link: #7cbfff; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
main { max-width: 1240px; margin: 0 auto; padding: 32px 24px 48px; }
h1 { font-size: 27px; line-height: 1.25; font-weight: 650; margin: 0 0 4px; }
h2 { font-size: 19px; font-weight: 600; margin: 36px 0 12px; }
h3 { font-size: 15px; font-weight: 600; margin: 0 0 8px; }
p, figcaption { color: var(--soft); margin: 4px 0; }
a { color: var(--link); }
code { font: 13px ui-monospace, "DejaVu Sans Mono", Consolas, monospace; }
.cards { columns: 3 340px; column-gap: 16px; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 480px), 1fr)); gap: 16px; }
.card, figure { background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 14px 16px; margin: 0; }
.card { break-inside: avoid; margin-bottom: 16px; overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th { text-align: left; font-weight: 400; color: var(--soft); padding: 3px 16px 3px 0; vertical-align: top; }
thead th { font-weight: 600; text-align: right; padding: 3px 0 3px 14px; }
thead th:first-child, .rows td:first-child { text-align: left; padding-left: 0; }
td { padding: 3px 0; text-align: right; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
td.text { text-align: left; } td.text span { color: var(--soft); display: block; }
td + td { padding-left: 14px; }
tr + tr > *, tbody tr > * { border-top: 1px solid var(--grid); }
.facts { max-width: 860px; } .facts td, .facts th { text-align: left; }
.verdict { font-weight: 600; color: var(--ink); }
details > summary { font-size: 19px; font-weight: 600; margin: 36px 0 12px; cursor: pointer; }
.files { max-width: 640px; } .files td { text-align: left; }
table > tbody:first-child > tr:first-child > * { border-top: 0; }
svg { display: block; width: 100%; height: auto; }
svg text { fill: var(--soft); font: 12px system-ui, "Segoe UI", Roboto, Arial, sans-serif; }
svg .end { text-anchor: end; } svg .middle { text-anchor: middle; } svg .strong { fill: var(--ink); font-weight: 600; }
svg .grid { stroke: var(--grid); } svg .axis { stroke: var(--rule); }
svg .curve { fill: none; stroke: var(--line); stroke-width: 1.6; stroke-linejoin: round; }
svg .shade { fill: var(--grid); }
svg .mean { stroke: var(--soft); stroke-dasharray: 2 4; }
.legend { display: flex; flex-wrap: wrap; gap: 4px 18px; margin-top: 10px; font-size: 13px; color: var(--soft); }
.legend i { display: inline-block; width: 11px; height: 11px; border-radius: 3px; margin-right: 6px; vertical-align: -1px; }
.c0 { fill: #3b82c4; background: #3b82c4; } .c1 { fill: #e08a2e; background: #e08a2e; } .c2 { fill: #3fa66b; background: #3fa66b; }
.c3 { fill: #c2558a; background: #c2558a; } .c4 { fill: #8467c7; background: #8467c7; } .c5 { fill: #c9a227; background: #c9a227; }
.c6 { fill: #2fa3a3; background: #2fa3a3; } .c7 { fill: #b05a48; background: #b05a48; } .c8 { fill: #6a9a2d; background: #6a9a2d; }
.c9 { fill: #98a4b0; background: #98a4b0; }
svg text.inside { fill: #ffffff; font-size: 11px; }
@media print { body { background: none; } main { padding: 0; } }
)css";

}  // namespace

std::string escaped(std::string_view text) {
    std::string safe;
    for (char const c : printable(text)) switch (c) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += c;
        }
    return safe;
}

std::string readable_words(std::string_view key) {
    std::string words(key);
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

/// Capitalises the first letter of the words.
std::string readable_name(std::string_view key) {
    std::string name = readable_words(key);
    if (!name.empty() && name[0] >= 'a' && name[0] <= 'z')
        name[0] = static_cast<char>(name[0] - 'a' + 'A');
    return name;
}

std::string readable_number(double value) { return fmt::format("{:.6g}", value); }

std::string html_page(std::string const& title, std::string const& body) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, "
        "initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n</head>\n"
        "<body>\n<main>\n{}</main>\n</body>\n</html>\n",
        escaped(title), style, body);
}

}  // namespace catena
