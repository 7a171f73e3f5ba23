// Prepares the process: open standard descriptors and ignored signals, so that a program can write
// files for hours.
#pragma once

#include <spawn.h>

namespace catena::command {

/// Opens descriptors 0 to 2 on /dev/null if they are closed, so that no file of a run gets their
/// numbers. Ignores SIGPIPE and SIGXFSZ, so that write() returns EPIPE or EFBIG instead. Call this
/// before anything is opened.
void prepare_process();

/// Attributes for posix_spawn that reset the signals ignored by prepare_process() to their defaults
/// in the started program.
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
