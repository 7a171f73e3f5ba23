// What reaches standard output and standard error: valid UTF-8 without control characters, whatever
// names files brought.
#pragma once

#include <string>

namespace catena::command {

constexpr char const* out_of_memory =
    "the computation does not fit into memory: run it on more ranks, or make fewer bodies";

/// To standard output, as it is. Quiet where nobody reads it any more (`catena check SCENE | head
/// -1`); ComputationError where it cannot be written otherwise.
void print(std::string const& text);
/// "catena: LINE" on standard error, in one line.
void say_error(std::string const& line);
/// The log on standard error: "catena: warning: ...". `level`: as spdlog names it.
void start_log(std::string const& level);
/// Whether errors alone are logged.
bool is_quiet();

}  // namespace catena::command
