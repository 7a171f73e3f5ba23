// The result of a command: a text for people, JSON for programs, and whether its checks hold.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace catena::command {

using Json = nlohmann::ordered_json;

/// Result of a command. Text and JSON are complete on rank 0 only.
struct Outcome {
    std::string text;
    Json json;
    bool valid = true;
    /// False if the command was stopped on request before its end.
    bool whole = true;
    /// Error and remedy if the outcome is not valid or not whole, for users who do not see `text`.
    std::string complaint = {};
};

/// Returns JSON with one key per line and lists of plain values on one line. Numbers read back to
/// the same doubles; values that are not finite become null.
std::string json_text(Json const&);

}  // namespace catena::command
