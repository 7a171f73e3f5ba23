// Finds and runs programs that accompany this one: scripts of the source tree, a Python with the
// modules they need, and executables of the build tree.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace catena::command {

/// Runs a program and drops what it prints. Returns its exit status, or -1 if it could not be
/// started or was ended by a signal.
int run_quietly(std::vector<std::string> words);

/// Finds a file by its path in the source tree that the program was built in, or in the current
/// folder.
std::optional<std::filesystem::path> find_in_source_tree(std::string const& path);
/// Finds a file by its path in the build tree: in the program's own folder or one above it.
std::optional<std::filesystem::path> find_in_build_tree(std::string const& path);

/// Finds a Python that can import a module: the one of VIRTUAL_ENV, of a folder `venv` or
/// `peers-venv` above the program, or on PATH.
std::optional<std::string> find_python(std::string const& module);

}  // namespace catena::command
