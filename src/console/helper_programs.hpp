// Programs that stand beside this one: scripts of the source tree, a Python that has what they
// need, what the build tree holds.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace catena::command {

/// Exit status, -1 where the program could not be started. What it prints is dropped.
int run_quietly(std::vector<std::string> words);

/// A file by its path in the source tree the program was built in, or in the folder it is started
/// from.
std::optional<std::filesystem::path> find_in_source_tree(std::string const& path);
/// A file by its path in the build tree, the program's own folder or one above it.
std::optional<std::filesystem::path> find_in_build_tree(std::string const& path);

/// A Python that can import a module: that of VIRTUAL_ENV, of a folder `venv` or `peers-venv` above
/// the program, or on PATH.
std::optional<std::string> find_python(std::string const& module);

}  // namespace catena::command
