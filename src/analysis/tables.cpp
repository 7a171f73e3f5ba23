// Writes the tables of an analysis.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "analysis/analysis.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"

namespace catena::analysis {
namespace {

/// Returns a number that reads back to the same double; empty if it is not finite.
std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.17g}", value) : "";
}

/// Returns a text as a field of a CSV file.
std::string field(std::string const& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (char const c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

std::string estimate(Estimate const& e) {
    return fmt::format("{},{},{},{}", number(e.mean), number(e.error), number(e.between),
                       std::isfinite(e.error) ? (e.plateau ? "yes" : "no") : "");
}

std::string summary(Analysis const& analysis) {
    std::string text =
        "quantity,chains,unit,value,error_by_blocking,error_between_copies,plateau,basis\n";
    for (Quantity const& q : analysis.quantities)
        text += fmt::format("{},{},{},{},{}\n", q.name, field(q.kind), field(q.unit),
                            estimate(q.value), field(q.basis));
    return text;
}

/// Removes what an earlier analysis left, so that the folder holds one analysis.
void remove_earlier(std::filesystem::path const& folder) {
    std::error_code ignored;
    for (char const* name :
         {"radius_distribution.csv", "internal_distances.csv", "bond_correlation.csv",
          "displacement.csv", "density.csv", "analysis.png"})
        std::filesystem::remove(folder / name, ignored);
}

std::string with_unit(std::string const& name, std::string const& unit) {
    return unit.empty() ? name : name + " [" + unit + "]";
}

}  // namespace

std::vector<std::string> write_tables(Analysis const& analysis, std::string const& folder) {
    auto const path = [&](std::string const& name) {
        return (std::filesystem::path(folder) / name).string();
    };
    remove_earlier(folder);
    std::vector<std::string> written{path("summary.csv")};
    write_text_file(written.back(), summary(analysis));
    std::map<std::string, std::string> tables;
    for (Curve const& curve : analysis.curves) {
        std::string& text = tables[curve.name];
        if (text.empty())
            text = fmt::format("chains,{},{},error_by_blocking,error_between_copies,plateau\n",
                               with_unit(curve.variable, curve.variable_unit),
                               with_unit("value", curve.unit));
        for (std::size_t k = 0; k < curve.x.size(); ++k)
            text += fmt::format("{},{},{}\n", field(curve.kind), number(curve.x[k]),
                                estimate(curve.y[k]));
    }
    for (auto const& [name, text] : tables) {
        written.push_back(path(name + ".csv"));
        write_text_file(written.back(), text);
    }
    written.push_back(path("maps.h5"));
    write_maps(analysis, written.back());
    return written;
}

}  // namespace catena::analysis
