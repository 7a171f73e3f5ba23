// Implements the conversation with another program over a pair of sockets.
#include "bench/peer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include "console/helper_programs.hpp"
#include "console/process.hpp"
#include "console/text.hpp"
#include "error.hpp"

namespace catena::command {
namespace {

constexpr std::size_t longest_answer = 1 << 16;

/// Returns a peer that is a Python script, or why it is missing.
PeerProgram python_peer(std::string const& name, std::string const& module,
                        std::string const& package, std::vector<std::string> const& options) {
    std::string const path = "tests/bench/peers/peer_" + module + ".py";
    PeerProgram program{name, {}, options, ""};
    auto const script = find_in_source_tree(path);
    auto const python = script ? find_python(module) : std::nullopt;
    if (!script) program.missing = path + " was not found near this program";
    if (script && !python)
        program.missing = "no Python was found that imports " + module + " (PyPI: " + package +
                          "; see tests/bench/peers/README.md)";
    if (script && python) program.words = {*python, script->string()};
    return program;
}

/// Returns the peer for Simbody, or why it is missing.
PeerProgram simbody() {
    auto const program = find_in_build_tree("tests/bench/peer-simbody");
    if (program) return {"simbody", {program->string()}, {}, ""};
    return {"simbody",
            {},
            {},
            "tests/bench/peer-simbody was not built (Debian: libsimbody-dev, then configure and "
            "build again)"};
}

/// Returns the last line of a file that is not empty.
std::string last_line(std::string const& file) {
    std::ifstream in(file);
    std::string last;
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) last = line;
    return last;
}

}  // namespace

std::vector<PeerProgram> peer_programs() {
    return {python_peer("pinocchio, local", "pinocchio", "pin", {"local"}),
            python_peer("pinocchio, world", "pinocchio", "pin", {"world"}), simbody(),
            python_peer("mujoco", "mujoco", "mujoco", {})};
}

Peer::Peer(PeerProgram const& program, std::string const& chain_file,
           std::string const& accelerations_file, Limits limits)
    : limits_(limits),
      accelerations_file_(accelerations_file),
      errors_file_(accelerations_file + ".log") {
    // The shell sets the limit and then becomes the program.
    std::vector<std::string> words{
        "/bin/sh", "-c", fmt::format("ulimit -v {}; exec \"$@\"", limits.memory_bytes / 1024),
        "sh"};
    words.insert(words.end(), program.words.begin(), program.words.end());
    words.insert(words.end(), {chain_file, accelerations_file});
    words.insert(words.end(), program.options.begin(), program.options.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    // Sockets are used because writing to a pipe that nobody reads would end this program.
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw ComputationError("cannot open a socket to another program");
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors_file_.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0644);
    int const started =
        ::posix_spawn(&child_, argv[0], &actions, DefaultSignals().get(), argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    talk_ = ends[0];
    if (started != 0) {
        child_ = -1;
        stopped_ = "not started: " + std::string(std::strerror(started));
    }
}

Peer::~Peer() {
    stop("not needed any more");
    ::close(talk_);
}

bool Peer::is_ready() {
    std::string const answer = line(limits_.set_up, "building the chain and evaluating it once");
    if (!stopped_.empty()) return false;
    description_ = Json::parse(answer, nullptr, false);
    auto const is_text = [this](char const* key) {
        return !description_.contains(key) || description_.at(key).is_string();
    };
    if (!description_.is_object() || !is_text("stops") || !is_text("version") || !is_text("method"))
        stop("unreadable answer: " + answer);
    else if (description_.contains("stops"))
        stop(description_.at("stops").get<std::string>());
    return stopped_.empty();
}

bool Peer::is_ready_for_next() {
    if (!stopped_.empty()) return false;
    ask("next\n");
    return is_ready();
}

double Peer::time(int evaluations) {
    if (!stopped_.empty()) return -1;
    ask(std::to_string(evaluations) + "\n");
    std::string const answer = line(evaluations * limits_.evaluation, "evaluating");
    char* end = nullptr;
    double const seconds = std::strtod(answer.c_str(), &end);
    if (stopped_.empty() && (end == answer.c_str() || !(seconds >= 0)))
        stop("the answer is not a time: " + answer);
    return stopped_.empty() ? seconds : -1;
}

std::vector<double> Peer::accelerations() const {
    std::ifstream in(accelerations_file_, std::ios::binary | std::ios::ate);
    std::vector<double> found(in ? static_cast<std::size_t>(in.tellg()) / sizeof(double) : 0);
    in.seekg(0);
    in.read(reinterpret_cast<char*>(found.data()),
            static_cast<std::streamsize>(found.size() * sizeof(double)));
    return found;
}

/// Sends a question. A program that has ended gives no answer; output before the question is an
/// error.
void Peer::ask(std::string const& question) {
    char some[100];
    ssize_t const count = ::recv(talk_, some, sizeof(some), MSG_DONTWAIT | MSG_PEEK);
    if (count > 0) rest_.append(some, static_cast<std::size_t>(count));
    if (!rest_.empty()) stop("unexpected output: " + rest_.substr(0, 100));
    ::send(talk_, question.data(), question.size(), MSG_NOSIGNAL);
}

/// Returns the next line of output. Stops the program if there is none within `patience`.
std::string Peer::line(std::chrono::duration<double> patience, std::string const& doing) {
    auto const until = std::chrono::steady_clock::now() + patience;
    while (stopped_.empty()) {
        if (std::size_t const end = rest_.find('\n'); end != std::string::npos) {
            std::string const found = rest_.substr(0, end);
            rest_.erase(0, end + 1);
            return found;
        }
        auto const left =
            std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now())
                .count();
        pollfd waiting{talk_, POLLIN, 0};
        int const ready = left > 0 ? ::poll(&waiting, 1, static_cast<int>(left)) : 0;
        if (ready < 0 && errno == EINTR) continue;
        char some[4096];
        ssize_t const count = ready > 0 ? ::read(talk_, some, sizeof(some)) : 0;
        if (count > 0) rest_.append(some, static_cast<std::size_t>(count));
        if (rest_.size() > longest_answer) stop("unterminated line: " + rest_.substr(0, 100));
        if (ready == 0)
            stop(fmt::format("{} takes more than {}", doing, duration_text(patience.count())));
        if (ready > 0 && count <= 0) stop(how_it_ended());
    }
    return "";
}

/// Describes how a silent program ended. If it still runs after a second, it will be killed.
std::string Peer::how_it_ended() {
    int status = 0;
    for (int tenths = 0; ::waitpid(child_, &status, WNOHANG) == 0; ++tenths) {
        if (tenths == 10) return "it closed its output and kept running";
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    child_ = -1;
    std::string const said = last_line(errors_file_);
    std::string const how = WIFSIGNALED(status)
                                ? fmt::format("ended by signal {} ({})", WTERMSIG(status),
                                              ::strsignal(WTERMSIG(status)))
                                : fmt::format("ended with status {}", WEXITSTATUS(status));
    return said.empty() ? how : how + ": " + said;
}

void Peer::stop(std::string const& why) {
    if (stopped_.empty()) stopped_ = why;
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
}

}  // namespace catena::command
