// Signals by which a user, a launcher or a batch system asks a run to stop. They are recorded, and
// the run ends after its current step.
#pragma once

#include <csignal>
#include <string>

namespace catena::command {

/// Records SIGTERM, SIGUSR1, SIGHUP, SIGXCPU and the first SIGINT while it lives. A second SIGINT
/// ends the process at once. A SIGHUP that was ignored before (nohup) stays ignored. Only one
/// object may exist at a time.
class StopSignals {
  public:
    StopSignals();
    StopSignals(StopSignals const&) = delete;
    StopSignals& operator=(StopSignals const&) = delete;
    ~StopSignals();

    /// Returns the number of the last recorded signal; 0 if there was none.
    static int noted();
    /// Returns for example "SIGTERM".
    static std::string name_of(int signal);

  private:
    static constexpr int how_many = 5;
    struct sigaction before_[how_many];
};

}  // namespace catena::command
