// A scene and the one line that refuses it.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <regex>
#include <string>
#include <vector>

#include "error.hpp"
#include "reader/load_scene.hpp"
#include "scene/scene.hpp"

namespace catena::test {

/// The message of the InputError that the scene gives; "accepted" if it gives none. Any other
/// exception is the caller's.
inline std::string refusal_of(std::string const& yaml,
                              std::vector<std::string> const& overrides = {},
                              std::string const& file = "s.yaml") {
    try {
        parse_scene(yaml, file, overrides);
    } catch (InputError const& error) {
        return error.what();
    }
    return "accepted";
}

struct Refusal {
    char const* name;
    char const* yaml;
    char const* message;
};
inline std::ostream& operator<<(std::ostream& stream, Refusal const& refusal) {
    return stream << refusal.yaml;
}
inline std::string name_of_case(testing::TestParamInfo<Refusal> const& info) {
    return info.param.name;
}

class Refused : public testing::TestWithParam<Refusal> {};

}  // namespace catena::test
