// Implements the picture of rigid domains.
#include "page/domain_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "page/axis.hpp"
#include "page/html.hpp"

namespace catena {
namespace {

// Sizes in pixels: panels, margins, and the whole picture of one chain.
constexpr double left = 60, right = 120, panel = 520, width = left + panel + right, top = 34,
                 curve_height = 150, gap = 46, bottom = 46;
constexpr double map_top = top + curve_height + gap, height = map_top + panel + bottom;
constexpr std::size_t most_cells = 130;  // cells of the matrix in a row
constexpr double largest_shown = 30;     // angstrom; larger errors are white
constexpr int shades = 15;
constexpr char const *band = "#ffe2b8", *edge = "#d55e00";

/// Colour of an error: dark green for 0, white for the largest.
std::string colour_of(int shade) {
    double const part = static_cast<double>(shade) / shades;
    auto const mixed = [&](double dark) {
        return static_cast<int>(std::lround(dark + part * (255 - dark)));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", mixed(0), mixed(80), mixed(30));
}

/// Draws one chain.
class Drawing {
  public:
    explicit Drawing(DomainPicture const& of)
        : of_(of), axis_(linear_axis(1, static_cast<double>(of.plddt.size()), 0, 7)) {}

    std::string svg() const {
        return fmt::format("<text x=\"4\" y=\"16\" font-weight=\"600\">{}</text>\n",
                           escaped(of_.title)) +
               curve_panel() + matrix_panel();
    }

  private:
    /// Left edge of residue k, pixels.
    double at(double k) const { return left + panel * k / static_cast<double>(of_.plddt.size()); }
    /// Ticks of residues below a panel that ends at `y`.
    std::string residue_ticks(double y) const {
        std::string svg;
        for (Axis::Tick const& tick : axis_.ticks) {
            if (tick.value < 1) continue;
            double const x = at(tick.value - 0.5);
            svg += fmt::format(
                "<line class=\"axis\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text "
                "text-anchor=\"middle\" x=\"{0:.1f}\" y=\"{3}\">{4}</text>\n",
                x, y, y + 4, y + 17, tick.label);
        }
        return svg;
    }
    std::string curve_panel() const {
        auto const y_of = [](double plddt) { return top + curve_height * (1 - plddt / 100); };
        std::string svg;
        for (std::size_t d = 0; d < of_.domains.size(); ++d) {
            auto const [first, last] = of_.domains[d];
            double const x = at(static_cast<double>(first)),
                         end = at(static_cast<double>(last) + 1);
            svg += fmt::format(
                "<rect x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/><text "
                "text-anchor=\"middle\" x=\"{:.1f}\" y=\"{}\">{}</text>\n",
                x, top, end - x, curve_height, band, (x + end) / 2, top + curve_height - 6, d + 1);
        }
        for (double const plddt : {0.0, 50.0, 100.0})
            svg += fmt::format(
                "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text "
                "text-anchor=\"end\" x=\"{3}\" y=\"{4:.1f}\">{5:g}</text>\n",
                left, left + panel, y_of(plddt), left - 8, y_of(plddt) + 4, plddt);
        svg += fmt::format(
            "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\" "
            "stroke-dasharray=\"5 4\"/><text x=\"{4}\" y=\"{5:.1f}\">pLDDT {6:g}</text>\n",
            left, left + panel, y_of(of_.least_plddt), edge, left + panel + 6,
            y_of(of_.least_plddt) + 4, of_.least_plddt);
        svg += "<polyline points=\"";
        for (std::size_t k = 0; k < of_.plddt.size(); ++k)
            svg +=
                fmt::format("{:.1f},{:.1f} ", at(static_cast<double>(k) + 0.5), y_of(of_.plddt[k]));
        return svg + "\"/>\n" + residue_ticks(top + curve_height) +
               fmt::format("<text x=\"4\" y=\"{}\">pLDDT</text>\n", top - 6);
    }
    /// Shade of the mean error of two ranges of residues.
    int shade(std::size_t i, std::size_t i_end, std::size_t j, std::size_t j_end) const {
        double sum = 0;
        for (std::size_t a = i; a < i_end; ++a)
            for (std::size_t b = j; b < j_end; ++b) sum += of_.error(a, b);
        double const mean = sum / static_cast<double>((i_end - i) * (j_end - j));
        return static_cast<int>(std::lround(shades * std::min(1.0, mean / largest_shown)));
    }
    std::string matrix_panel() const {
        std::size_t const n = of_.plddt.size(), cells = std::min(n, most_cells);
        std::string svg;
        double const size = panel / static_cast<double>(cells);
        for (std::size_t i = 0; i < cells; ++i) {
            std::size_t begin = 0;
            int colour = -1;
            for (std::size_t j = 0; j <= cells; ++j) {
                int const here = j < cells ? shade(i * n / cells, (i + 1) * n / cells,
                                                   j * n / cells, (j + 1) * n / cells)
                                           : -1;
                if (here == colour) continue;
                // White cells need no rectangle.
                if (colour >= 0 && colour < shades)
                    svg += fmt::format(
                        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                        "fill=\"{}\"/>",
                        left + size * static_cast<double>(begin),
                        map_top + size * static_cast<double>(i),
                        size * static_cast<double>(j - begin) + 0.2, size + 0.2, colour_of(colour));
                begin = j;
                colour = here;
            }
            svg += "\n";
        }
        svg += fmt::format(
            "<rect x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{2}\" fill=\"none\" "
            "class=\"axis\"/>\n",
            left, map_top, panel);
        for (auto const& [first, last] : of_.domains) {
            double const from = at(static_cast<double>(first)) - left,
                         to = at(static_cast<double>(last) + 1) - left;
            svg += fmt::format(
                "<rect x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{2:.1f}\" "
                "fill=\"none\" stroke=\"{3}\" stroke-width=\"2\"/>\n",
                left + from, map_top + from, to - from, edge);
        }
        return svg + residue_ticks(map_top + panel) + legend() +
               fmt::format(
                   "<text text-anchor=\"middle\" x=\"{}\" y=\"{}\">residue, counted along the "
                   "chain</text>\n<text x=\"4\" y=\"{}\">predicted aligned error</text>\n",
                   left + panel / 2, map_top + panel + 36, map_top - 8);
    }
    /// Scale of the errors, beside the matrix.
    std::string legend() const {
        double const x = left + panel + 18, step = 12;
        std::string svg;
        for (int s = 0; s <= shades; ++s)
            svg += fmt::format(
                "<rect x=\"{}\" y=\"{:.1f}\" width=\"14\" height=\"{}\" fill=\"{}\" "
                "class=\"axis\"/>",
                x, map_top + step * s, step, colour_of(s));
        auto const label = [&](double error, std::string const& text) {
            svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\">{}</text>\n", x + 20,
                               map_top + step * (0.5 + shades * error / largest_shown) + 4, text);
        };
        label(0, "0 Å");
        label(of_.largest_error, fmt::format("{:g} Å", of_.largest_error));
        label(largest_shown, fmt::format("{:g} Å", largest_shown));
        return svg;
    }

    DomainPicture const& of_;
    Axis axis_;
};

}  // namespace

std::string domain_pictures(std::vector<DomainPicture> const& pictures) {
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" role=\"img\">\n"
        "<style>text {{ fill: #1b2733; font: 12px system-ui, \"Segoe UI\", Roboto, Arial, "
        "sans-serif; }} .grid {{ stroke: #e9edf1; }} .axis {{ stroke: #9aa8b5; }} polyline {{ "
        "fill: none; stroke: #0072b2; stroke-width: 1.4; stroke-linejoin: round; }}</style>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        width, height * static_cast<double>(pictures.size()));
    for (std::size_t i = 0; i < pictures.size(); ++i)
        svg += fmt::format("<g transform=\"translate(0,{})\">\n{}</g>\n",
                           height * static_cast<double>(i), Drawing(pictures[i]).svg());
    return svg + "</svg>\n";
}

}  // namespace catena
