// Reads the values of options as strictly as those of a scene. Messages name the option.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// Throws InputError if an output file is the scene or two output files are the same. An empty name
/// means not given, "-" means standard output.
void require_files_apart(std::string const& scene, std::string const& json,
                         std::string const& accelerations);

/// Checks the name of a file that a command will write, before the work whose result it holds.
/// Throws InputError if a folder has that name, or if the folder to hold the file is missing.
/// `option`, such as "--json", names the file in the message. An empty name and "-" are accepted.
void require_writable(std::string const& option, std::string const& file);

/// Reads digits, or a number without a fraction such as 1e6. Throws InputError unless it is in
/// [least, most].
std::int64_t whole_number(std::string const& option, std::string const& text, std::int64_t least,
                          std::int64_t most = INT64_MAX);
/// Reads a number from `least` to `most`. Throws InputError naming the option for anything else.
double number_between(std::string const& option, std::string const& text, double least,
                      double most);
/// A unit and its value in the base unit.
struct Unit {
    std::string_view name;
    double worth;
};
/// Reads a positive number followed by one of the units ("1.5us"), in the base unit. Throws
/// InputError for anything else.
double number_with_unit(std::string const& option, std::string const& text,
                        std::span<Unit const> units);
/// Returns the value if it is among `known`. Throws InputError with the nearest known one
/// otherwise.
std::string const& known_value(std::string const& option, std::string const& text,
                               std::span<std::string_view const> known);
/// Returns the parts between commas. Throws InputError if one is empty.
std::vector<std::string> comma_list(std::string const& option, std::string const& text);
/// Returns the backend of a name. Throws InputError for an unknown one.
Backend backend_named(std::string const& option, std::string const& text);

/// Returns "did you mean `...`?" or "use one of ...".
std::string remedy_for(std::string_view text, std::span<std::string_view const> known);

}  // namespace catena::command
