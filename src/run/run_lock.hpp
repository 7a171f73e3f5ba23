// Lock of a run's folder, which has one writer. The run holds it from before its first change until
// its end.
#pragma once

#include <string>

namespace catena {

/// Name of the lock's file. It states who writes there, for the messages of other runs.
inline constexpr char const* run_lock_name = "run.lock";

/// Lock that is held during the object's lifetime and that vanishes with the process, however that
/// ends. It uses flock. File systems without flock use the existence of the file, which counts on
/// this host as long as the process that created it exists.
class RunLock {
  public:
    /// Locks an existing folder. Throws InputError, which names host and process, if another run
    /// holds the lock, and if the folder is not writable.
    explicit RunLock(std::string const& folder);
    RunLock(RunLock const&) = delete;
    RunLock& operator=(RunLock const&) = delete;
    ~RunLock();

    /// Throws the same InputError if another run holds the lock of `folder`. Nothing is locked or
    /// created.
    static void refuse_if_taken(std::string const& folder);

  private:
    std::string file_;
    int descriptor_ = -1;
};

}  // namespace catena
