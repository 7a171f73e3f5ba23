// Writes to standard output and standard error: valid UTF-8 without control characters, even if
// file names or scenes contain them.
#pragma once

#include <string>

namespace catena::command {

/// Message for every failure to allocate memory. It names `ulimit -v` where that is the limit.
char const* out_of_memory();

/// Writes to standard output without changes. Ignores a closed pipe (`catena check SCENE | head
/// -1`); throws ComputationError for any other failure.
void print(std::string const& text);
/// Writes "catena: LINE" to standard error on one line.
void say_error(std::string const& line);
/// Starts the log on standard error: "catena: warning: ...". `level` is a level name of spdlog.
void start_log(std::string const& level);
/// True if the log shows errors only.
bool is_quiet();

}  // namespace catena::command
