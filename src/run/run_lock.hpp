// A run's folder has one writer: a lock that the run holds from before it touches anything to its
// end.
#pragma once

#include <string>

namespace catena {

/// The file of a run's folder that holds its lock: who writes there, for others' messages.
inline constexpr char const* run_lock_name = "run.lock";

/// Held while it lives, and gone with the process, however that ends: by flock or, where the file
/// system has none, by the file's being there, which on this host counts as long as the process
/// does that made it.
class RunLock {
  public:
    /// Takes the lock of a folder that exists. Throws InputError, which names host and process,
    /// where another run holds it, and where the folder cannot be written to.
    explicit RunLock(std::string const& folder);
    RunLock(RunLock const&) = delete;
    RunLock& operator=(RunLock const&) = delete;
    ~RunLock();

    /// The same InputError where another run holds the lock of `folder`; nothing is taken or made.
    static void refuse_if_taken(std::string const& folder);

  private:
    std::string file_;
    int descriptor_ = -1;
};

}  // namespace catena
