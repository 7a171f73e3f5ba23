// Values of options, read as strictly as a scene's, with messages that name the option.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// Digits, or a number without a fraction such as 1e6, in [least, most].
/// That neither the scene nor one of them is written over; empty: not given, "-": standard output.
void require_files_apart(std::string const& scene, std::string const& json,
                         std::string const& accelerations);

std::int64_t whole_number(std::string const& option, std::string const& text, std::int64_t least,
                          std::int64_t most = INT64_MAX);
/// A positive number with one of the units behind it ("1.5us"), times what the unit is worth.
struct Unit {
    std::string_view name;
    double worth;
};
double number_with_unit(std::string const& option, std::string const& text,
                        std::span<Unit const> units);
/// The value itself when it is among `known`; InputError with the nearest known one otherwise.
std::string const& known_value(std::string const& option, std::string const& text,
                               std::span<std::string_view const> known);
/// Parts between commas, none of them empty.
std::vector<std::string> comma_list(std::string const& option, std::string const& text);
/// Throws "not in this version" for the GPU's, InputError for an unknown one.
Backend backend_named(std::string const& option, std::string const& text);

/// "did you mean `...`?" or "use one of ...".
std::string remedy_for(std::string_view text, std::span<std::string_view const> known);

}  // namespace catena::command
