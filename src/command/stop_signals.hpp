// The signals by which a user, a launcher or a batch system asks a run to stop: noted, not obeyed
// at once.
#pragma once

#include <csignal>
#include <string>

namespace catena::command {

/// While it lives SIGTERM, SIGUSR1, SIGHUP, SIGXCPU and the first SIGINT are noted; a second SIGINT
/// ends the process at once. A SIGHUP that was ignored before (nohup) stays ignored. One at a time.
class StopSignals {
  public:
    StopSignals();
    StopSignals(StopSignals const&) = delete;
    StopSignals& operator=(StopSignals const&) = delete;
    ~StopSignals();

    /// The last one noted, 0 if none was.
    static int noted();
    /// "SIGTERM"
    static std::string name_of(int signal);

  private:
    static constexpr int how_many = 5;
    struct sigaction before_[how_many];
};

}  // namespace catena::command
