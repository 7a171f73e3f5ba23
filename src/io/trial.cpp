// Implements trials by fork(), resource limits and waitpid().
#include "io/trial.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace catena {
namespace {

double constexpr best_compression = 1100;  // deflate expands a byte to 1032 at most
double constexpr seconds_per_byte = 1e-8;  // uncompressed bytes

/// Signals that end a crashing process. Other signals are sent from outside and say nothing about a
/// file.
constexpr int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU};
constexpr int from_outside[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2};

/// Restores the default handling of SIGCHLD, so that children can be waited for even if the parent
/// process made this one ignore their ends.
class Waiting {
  public:
    Waiting() {
        struct sigaction wanted{};
        wanted.sa_handler = SIG_DFL;
        ::sigaction(SIGCHLD, &wanted, &before_);
    }
    ~Waiting() { ::sigaction(SIGCHLD, &before_, nullptr); }
    Waiting(Waiting const&) = delete;
    Waiting& operator=(Waiting const&) = delete;

  private:
    struct sigaction before_{};
};

/// Bytes of address space that this process uses.
std::int64_t address_space() {
    std::ifstream in("/proc/self/statm");
    std::int64_t pages = 0;
    in >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

/// Sets a soft limit of this process, at most its hard limit.
void limit(__rlimit_resource_t resource, std::int64_t most) {
    rlimit limits{};
    if (getrlimit(resource, &limits) != 0) return;
    limits.rlim_cur = std::min(limits.rlim_max, static_cast<rlim_t>(most));
    setrlimit(resource, &limits);
}

/// Silences the child: a fault ends it without output, dump or handler of MPI. Signals from outside
/// are ignored, and the limits are set.
void become_silent(TrialLimits const& limits) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_DUMPABLE, 0);
    for (int const number : faults) std::signal(number, SIG_DFL);
    for (int const number : from_outside) std::signal(number, SIG_IGN);
    int const nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    for (int const descriptor : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, descriptor);
    limit(RLIMIT_CPU, limits.seconds);
    limit(RLIMIT_AS, address_space() + limits.bytes);
}

/// Runs the action in the child process and ends that process.
[[noreturn]] void try_it(std::function<void()> const& action, TrialLimits const& limits) {
    become_silent(limits);
    try {
        action();
    } catch (...) {
        ::_exit(0);  // the process itself will fail alike and report it
    }
    ::_exit(0);
}

}  // namespace

TrialLimits limits_for_file(std::string const& file) {
    std::error_code ignored;
    std::uintmax_t const found = std::filesystem::file_size(file, ignored);
    double const size = ignored ? 0 : static_cast<double>(found);
    double const unpacked = best_compression * size;
    return {static_cast<std::int64_t>(std::clamp(unpacked, 0.8e9, 1e15)),
            10 + static_cast<std::int64_t>(unpacked * seconds_per_byte)};
}

std::string trial(std::function<void()> const& action, TrialLimits const& limits) {
    Waiting const waiting;
    pid_t const copy = ::fork();
    if (copy < 0) return "";
    if (copy == 0) try_it(action, limits);
    int status = 0;
    while (::waitpid(copy, &status, 0) < 0)
        if (errno != EINTR) return "";
    if (WIFEXITED(status))
        return WEXITSTATUS(status) == 0 ? "" : "status " + std::to_string(WEXITSTATUS(status));
    if (std::find(std::begin(faults), std::end(faults), WTERMSIG(status)) == std::end(faults))
        return "";
    return WTERMSIG(status) == SIGXCPU ? "no end within " + std::to_string(limits.seconds) + " s"
                                       : strsignal(WTERMSIG(status));
}

}  // namespace catena
