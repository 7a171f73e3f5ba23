// What a command found: a text for people, JSON for programs, and whether its checks hold.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace catena::command {

using Json = nlohmann::ordered_json;

/// Text and JSON count on rank 0.
struct Outcome {
    std::string text;
    Json json;
    bool valid = true;
    bool whole = true;           // false: stopped on request before its end
    std::string complaint = {};  // where it is not valid or whole: what is wrong and what to do,
                                 // for those who see nothing of `text`
};

/// Objects a key a line, lists of plain values on one line. Numbers read back to the same doubles;
/// what is not finite becomes null.
std::string json_text(Json const&);

}  // namespace catena::command
