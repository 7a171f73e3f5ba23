// Implements the recording of signals in an atomic number.
#include "command/stop_signals.hpp"

#include <atomic>

namespace catena::command {
namespace {

/// A recorded signal with its name and the flags of its handler.
struct Signal {
    int number;
    char const* name;
    int flags;
};
constexpr Signal signals[] = {{SIGTERM, "SIGTERM", SA_RESTART},
                              {SIGINT, "SIGINT", SA_RESTART | static_cast<int>(SA_RESETHAND)},
                              {SIGUSR1, "SIGUSR1", SA_RESTART},
                              {SIGHUP, "SIGHUP", SA_RESTART},
                              {SIGXCPU, "SIGXCPU", SA_RESTART}};

std::atomic<int> last{0};
static_assert(std::atomic<int>::is_always_lock_free, "signal handlers may not wait");

/// Handler that records the signal.
extern "C" void note(int signal) { last.store(signal); }

}  // namespace

StopSignals::StopSignals() {
    static_assert(std::size(signals) == how_many);
    last.store(0);
    for (int i = 0; i < how_many; ++i) {
        struct sigaction action{};
        action.sa_handler = note;
        action.sa_flags = signals[i].flags;
        ::sigaction(signals[i].number, &action, &before_[i]);
        if (signals[i].number == SIGHUP && before_[i].sa_handler == SIG_IGN)
            // A SIGHUP that nohup ignores stays ignored.
            ::sigaction(SIGHUP, &before_[i], nullptr);
    }
}

StopSignals::~StopSignals() {
    for (int i = 0; i < how_many; ++i) ::sigaction(signals[i].number, &before_[i], nullptr);
}

int StopSignals::noted() { return last.load(); }

std::string StopSignals::name_of(int signal) {
    for (Signal const& each : signals)
        if (each.number == signal) return each.name;
    return "signal " + std::to_string(signal);
}

}  // namespace catena::command
