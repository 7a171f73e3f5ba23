// Reads the chapter's figures from the table that is compiled into the program.
#include "report/chapter_figures.hpp"

#include <sstream>

namespace catena {
namespace {

char const* const table =
#include "report/chapter_figures.inc"
    ;

}  // namespace

std::map<std::string, std::map<std::int64_t, ChapterRow>> const& chapter_figures() {
    static auto const figures = [] {
        std::map<std::string, std::map<std::int64_t, ChapterRow>> read;
        std::istringstream lines(table);
        for (std::string line; std::getline(lines, line);) {
            if (line.empty() || line[0] == '#' || line.starts_with("figure,")) continue;
            std::istringstream cells(line);
            std::string figure, cell;
            std::getline(cells, figure, ',');
            std::getline(cells, cell, ',');
            ChapterRow& row = read[figure][std::stoll(cell)];
            for (double& number : row) {
                std::getline(cells, cell, ',');
                number = std::stod(cell);
            }
        }
        return read;
    }();
    return figures;
}

}  // namespace catena
