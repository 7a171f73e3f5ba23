#include "command/picture.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

namespace catena::command {
namespace {

namespace fs = std::filesystem;

/// Exit status, -1 where the program could not be started. What it prints is dropped.
int run_quietly(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    if (::posix_spawn_file_actions_init(&actions) != 0) return -1;
    for (int const stream : {STDOUT_FILENO, STDERR_FILENO}) ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = -1;
    int const started = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (started != 0) return -1;
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::vector<fs::path> folders_above_program() {
    std::error_code error;
    fs::path folder = fs::read_symlink("/proc/self/exe", error);
    std::vector<fs::path> folders;
    while (folder.has_relative_path()) folders.push_back(folder = folder.parent_path());
    return folders;
}

/// The script of the source tree the program was built in, or of the folder it is started from.
std::optional<fs::path> find_script(std::string const& name) {
    std::vector<fs::path> folders = folders_above_program();
    folders.emplace_back(".");
    for (fs::path const& folder : folders) {
        std::error_code ignored;
        if (fs::is_regular_file(folder / "jobs" / name, ignored)) return folder / "jobs" / name;
    }
    return std::nullopt;
}

std::optional<std::string> find_python() {
    std::vector<std::string> candidates;
    if (char const* const active = std::getenv("VIRTUAL_ENV"); active && *active) candidates.push_back(std::string(active) + "/bin/python");
    for (fs::path const& folder : folders_above_program()) {
        std::error_code ignored;
        if (fs::exists(folder / "venv" / "bin" / "python", ignored)) candidates.push_back((folder / "venv" / "bin" / "python").string());
    }
    candidates.emplace_back("python3");
    for (std::string const& python : candidates)
        if (run_quietly({python, "-c", "import matplotlib"}) == 0) return python;
    return std::nullopt;
}

}  // namespace

std::string draw_report(std::string const& report_json, std::string const& folder) {
    auto const script = find_script("report_plot.py");
    if (!script) return "no picture: jobs/report_plot.py is not beside this program; run it from the source tree on " + report_json;
    auto const python = find_python();
    std::string const words = script->string() + " " + report_json + " " + folder;
    if (!python) return "no picture: no Python with matplotlib was found; with one, run: python3 " + words;
    if (run_quietly({*python, script->string(), report_json, folder}) != 0)
        return "no picture: the script failed; see what it says: " + *python + " " + words;
    return "";
}

}  // namespace catena::command
