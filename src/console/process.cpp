// Implements the preparation of descriptors and signals.
#include "console/process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <initializer_list>

namespace catena::command {
namespace {

constexpr int ignored_signals[] = {SIGPIPE, SIGXFSZ};

}  // namespace

void prepare_process() {
    for (int const descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
        int const opened =
            // open() returns the lowest free number, which is the closed descriptor.
            ::open("/dev/null", O_RDWR);
        if (opened > STDERR_FILENO) ::close(opened);
    }
    for (int const number : ignored_signals) std::signal(number, SIG_IGN);
}

DefaultSignals::DefaultSignals() {
    sigset_t signals;
    ::sigemptyset(&signals);
    for (int const number : ignored_signals) ::sigaddset(&signals, number);
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
}

DefaultSignals::~DefaultSignals() { ::posix_spawnattr_destroy(&attributes_); }

}  // namespace catena::command
