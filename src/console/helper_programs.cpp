// Implements the search for scripts and Pythons, and runs them with posix_spawn.
#include "console/helper_programs.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "console/process.hpp"

namespace catena::command {
namespace {

namespace fs = std::filesystem;

/// Returns the folder of the executable and all folders above it, innermost first.
std::vector<fs::path> folders_above_program() {
    std::error_code error;
    fs::path folder = fs::read_symlink("/proc/self/exe", error);
    std::vector<fs::path> folders;
    while (folder.has_relative_path()) folders.push_back(folder = folder.parent_path());
    return folders;
}

/// Returns the first folder's file that exists.
std::optional<fs::path> find_file(std::vector<fs::path> const& folders, std::string const& path) {
    for (fs::path const& folder : folders) {
        std::error_code ignored;
        if (fs::is_regular_file(folder / path, ignored)) return folder / path;
    }
    return std::nullopt;
}

}  // namespace

int run_quietly(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    if (::posix_spawn_file_actions_init(&actions) != 0) return -1;
    for (int const stream : {STDOUT_FILENO, STDERR_FILENO})
        ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = -1;
    int const started =
        ::posix_spawnp(&child, argv[0], &actions, DefaultSignals().get(), argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (started != 0) return -1;
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::optional<fs::path> find_in_source_tree(std::string const& path) {
    std::vector<fs::path> folders = folders_above_program();
    folders.emplace_back(".");
    return find_file(folders, path);
}

std::optional<fs::path> find_in_build_tree(std::string const& path) {
    return find_file(folders_above_program(), path);
}

std::optional<std::string> find_python(std::string const& module) {
    std::vector<std::string> candidates;
    if (char const* const active = std::getenv("VIRTUAL_ENV"); active && *active)
        candidates.push_back(std::string(active) + "/bin/python");
    for (fs::path const& folder : folders_above_program())
        for (char const* const environment : {"venv", "peers-venv"}) {
            std::error_code ignored;
            if (fs::path const python = folder / environment / "bin" / "python";
                fs::exists(python, ignored))
                candidates.push_back(python.string());
        }
    candidates.emplace_back("python3");
    for (std::string const& python : candidates)
        if (run_quietly({python, "-c", "import " + module}) == 0) return python;
    return std::nullopt;
}

}  // namespace catena::command
