// What a process is given by whoever starts it, made fit for one that writes files for hours.
#pragma once

#include <spawn.h>

namespace catena::command {

/// Opens descriptors 0 to 2 on /dev/null where they are closed, so that no file of a run gets their
/// number. Ignores SIGPIPE and SIGXFSZ, so that write() says EPIPE or EFBIG instead. To be called
/// before anything is opened.
void prepare_process();

/// For posix_spawn: other programs start with the signals that prepare_process() ignores set back
/// to their defaults.
class DefaultSignals {
  public:
    DefaultSignals();
    DefaultSignals(DefaultSignals const&) = delete;
    DefaultSignals& operator=(DefaultSignals const&) = delete;
    ~DefaultSignals();
    posix_spawnattr_t const* get() const { return &attributes_; }

  private:
    posix_spawnattr_t attributes_;
};

}  // namespace catena::command
