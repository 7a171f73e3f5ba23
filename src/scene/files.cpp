// Implements the reading of text files and position tables.
#include "scene/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "scene/fields.hpp"
#include "scene/text_lines.hpp"

namespace catena::scene {

namespace {

/// True if no cell is a number or starts with a digit.
bool is_header(std::vector<std::string> const& cells) {
    double value = 0;
    for (std::string const& cell : cells)
        if (cell.empty() || parse_number(cell, value) != NumberFault::not_a_number ||
            std::isdigit(static_cast<unsigned char>(cell[0])))
            return false;
    return true;
}

[[noreturn]] void refuse_line(std::string const& what, std::string const& path, int line,
                              std::string const& remedy) {
    throw InputError(what, fmt::format("{}: line {}", path, line), remedy);
}

double cell_number(std::string const& cell, std::string const& path, int line) {
    double value = 0;
    switch (parse_number(cell, value)) {
        case NumberFault::none:
            return value;
        case NumberFault::not_a_number:
            refuse_line(fmt::format("`{}` is not a number", shown(cell)), path, line,
                        "give finite decimal numbers");
        case NumberFault::not_finite:
            refuse_line(fmt::format("`{}` is not finite", shown(cell)), path, line,
                        "give finite decimal numbers");
        case NumberFault::out_of_range:
            break;
    }
    refuse_line(fmt::format("`{}` is beyond the range of double precision", shown(cell)), path,
                line, "give finite decimal numbers");
}

}  // namespace

std::string ending_of(std::string const& path, bool packed) {
    std::string lower = path;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (packed && lower.ends_with(".gz")) lower.resize(lower.size() - 3);
    return std::filesystem::path(lower).extension().string();
}

bool holds_no_keys(std::string const& text) {
    try {
        return parse_value(text, "").kind != Node::Kind::map;
    } catch (InputError const&) {
        return false;
    }
}

std::string read_text_file(std::string const& path, Node const& at) {
    std::error_code unseen;
    auto const kind = std::filesystem::status(path, unseen).type();
    auto const refuse = [&](std::string const& what) {
        fail(at, fmt::format("{} `{}`", what, shown_path(path)), "check the path");
    };
    if (kind == std::filesystem::file_type::not_found) refuse("no such file:");
    if (unseen) refuse("the file cannot be accessed, " + unseen.message() + ":");
    if (kind == std::filesystem::file_type::directory) refuse("a folder, not a file:");
    if (kind != std::filesystem::file_type::regular) refuse("a device or pipe, not a file:");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        refuse("the file cannot be opened, " + std::generic_category().message(errno) + ":");
    std::ostringstream text;
    text << stream.rdbuf();
    if (stream.bad())
        fail(at, "the file cannot be read: `" + shown_path(path) + "`",
             "check the file and its permissions");
    return text.str();
}

std::string resolved(std::string const& path, std::string const& scene_file) {
    return (std::filesystem::path(scene_file).parent_path() / path).string();
}

std::vector<Vec3> read_position_table(std::string const& path, Node const& at) {
    std::vector<Vec3> positions;
    bool first = true;
    std::string text = read_text_file(path, at);
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // a byte order mark
    for (auto const& [n, line] : lines_of(text, '#')) {
        std::vector<std::string> const cells = cells_of(line);
        if (std::exchange(first, false) && is_header(cells)) continue;
        if (cells.size() != 3)
            refuse_line(fmt::format("the line has {} columns, not 3", cells.size()), path, n,
                        "give x,y,z");
        positions.push_back({{cell_number(cells[0], path, n), cell_number(cells[1], path, n),
                              cell_number(cells[2], path, n)}});
    }
    return positions;
}

}  // namespace catena::scene
