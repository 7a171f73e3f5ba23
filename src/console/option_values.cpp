// Implements the reading of numbers, names and lists on the command line.
#include "console/option_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "error.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"

namespace catena::command {

std::string remedy_for(std::string_view text, std::span<std::string_view const> known) {
    auto const near = scene::nearest(text, known);
    return near ? "did you mean `" + *near + "`?" : "use one of " + scene::joined(known);
}

void require_files_apart(std::string const& scene, std::string const& json,
                         std::string const& accelerations) {
    auto const is_same = [](std::string const& a, std::string const& b) {
        std::error_code ignored;
        auto const place = [&](std::string const& file) {
            return std::filesystem::weakly_canonical(file, ignored);
        };
        return !a.empty() && a != "-" && !b.empty() && place(a) == place(b);
    };
    for (auto const& [option, file] :
         {std::pair{"--json", json}, {"--accelerations", accelerations}})
        if (is_same(file, scene))
            throw InputError("the scene would be overwritten", std::string(option) + " " + file,
                             "name another file");
    if (is_same(json, accelerations))
        throw InputError("--json and --accelerations name the same file", "command line",
                         "name two files");
}

void require_writable(std::string const& option, std::string const& file) {
    if (file.empty() || file == "-") return;
    std::filesystem::path const path = file, folder = path.parent_path();
    std::string const where = option + " " + scene::shown_path(file);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError("this is a folder, not a file", where, "name a file");
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
        throw InputError("no such folder: " + scene::shown_path(folder.string()), where,
                         "create it, or name another file");
}

std::int64_t whole_number(std::string const& option, std::string const& text, std::int64_t least,
                          std::int64_t most) {
    double value = 0;
    scene::NumberFault const fault = scene::parse_number(text, value);
    bool const whole = fault == scene::NumberFault::none && std::floor(value) == value;
    std::int64_t const largest = std::min(most, std::int64_t{9'000'000'000'000'000});
    if (whole && value > static_cast<double>(largest))
        throw InputError(fmt::format("{} is above {}", text, largest), option,
                         fmt::format("give a whole number of at most {}", largest));
    if (!whole || value < -9.0e15)
        throw InputError(fmt::format("`{}` is not a whole number", text), option,
                         fmt::format("give a whole number of at least {}", least));
    auto const number = static_cast<std::int64_t>(value);
    if (number < least)
        throw InputError(fmt::format("{} is below {}", number, least), option,
                         fmt::format("give a whole number of at least {}", least));
    return number;
}

double number_between(std::string const& option, std::string const& text, double least,
                      double most) {
    double value = 0;
    if (scene::parse_number(text, value) != scene::NumberFault::none)
        throw InputError(fmt::format("`{}` is not a number", text), option,
                         fmt::format("give a number from {} to {}", least, most));
    if (!(value >= least && value <= most))
        throw InputError(fmt::format("{} is not between {} and {}", text, least, most), option,
                         "give a number in this range");
    return value;
}

double number_with_unit(std::string const& option, std::string const& text,
                        std::span<Unit const> units) {
    std::size_t const end = text.find_last_of("0123456789.");
    std::size_t const length = end == std::string::npos ? 0 : end + 1;
    std::string unit = text.substr(length);
    unit.erase(0, unit.find_first_not_of(' '));
    double value = 0;
    bool const good =
        scene::parse_number(text.substr(0, length), value) == scene::NumberFault::none && value > 0;
    auto const known = std::find_if(units.begin(), units.end(),
                                    [&](Unit const& each) { return each.name == unit; });
    if (good && known != units.end()) return value * known->worth;
    std::string names;
    for (Unit const& each : units) names += (names.empty() ? "" : ", ") + std::string(each.name);
    throw InputError(fmt::format("`{}` is not a positive number with a unit", text), option,
                     "write a number and one of these units: " + names);
}

std::string const& known_value(std::string const& option, std::string const& text,
                               std::span<std::string_view const> known) {
    if (std::find(known.begin(), known.end(), text) == known.end())
        throw InputError(fmt::format("`{}` is not a value of {}", text, option), "command line",
                         remedy_for(text, known));
    return text;
}

std::vector<std::string> comma_list(std::string const& option, std::string const& text) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        std::size_t const end = std::min(text.find(',', begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        if (parts.back().empty())
            throw InputError(fmt::format("`{}` has an empty part", text), option,
                             "separate values by single commas");
        begin = end + 1;
    }
    return parts;
}

Backend backend_named(std::string const& option, std::string const& text) {
    constexpr Backend all[] = {Backend::automatic, Backend::serial, Backend::segments,
                               Backend::openmp,    Backend::cuda,   Backend::cuda_levels};
    std::vector<std::string_view> names;
    for (Backend const backend : all) names.emplace_back(name_of(backend));
    known_value(option, text, names);
    return all[std::find(names.begin(), names.end(), text) - names.begin()];
}

}  // namespace catena::command
