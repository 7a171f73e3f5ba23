#include "tests/command/program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

std::string contents(std::string const& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

std::vector<char*> pointers(Words& words) {
    std::vector<char*> list;
    for (std::string& word : words) list.push_back(word.data());
    list.push_back(nullptr);
    return list;
}

Words split(std::string const& text) {
    Words words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, '|');)
        if (!word.empty()) words.push_back(word);
    return words;
}

}  // namespace

Ended run_program(Words const& words, std::string const& folder, Words const& environment) {
    TemporaryFolder const streams;
    std::string const out = streams / "out", err = streams / "err";
    Words all_words = words, all_environment = environment;
    for (char** variable = environ; *variable; ++variable) all_environment.emplace_back(*variable);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    if (!folder.empty()) ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT,
                                       0600);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT,
                                       0600);
    pid_t child = -1;
    int const failed = ::posix_spawnp(&child, all_words.front().c_str(), &actions, nullptr,
                                      pointers(all_words).data(), pointers(all_environment).data());
    ::posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (failed != 0 || ::waitpid(child, &status, 0) != child) return {};
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
}

Ended catena(Words const& words, std::string const& folder) {
    Words all{program()};
    all.insert(all.end(), words.begin(), words.end());
    return run_program(all, folder);
}

Ended catena_on(int ranks, Words const& words, std::string const& folder) {
    Words all = split(CATENA_MPIRUN);
    all.insert(all.end(), {"-n", std::to_string(ranks), program()});
    all.insert(all.end(), words.begin(), words.end());
    // Open MPI's own leaks are none of Catena's.
    return run_program(
        all, folder,
        {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
         "OMPI_MCA_btl_vader_single_copy_mechanism=none", "ASAN_OPTIONS=detect_leaks=0"});
}

std::string program() { return CATENA_PROGRAM; }
std::string input(std::string const& name) { return CATENA_SOURCE_DIR "/inputs/" + name; }

}  // namespace catena::test
