// A process that can create no threads, for tests of what then happens.
#pragma once

#include <pthread.h>

#include <cstddef>

namespace catena::test {

/// Threads' stacks that no memory has room for.
class NoMoreThreads {
  public:
    NoMoreThreads() {
        pthread_attr_t none;
        pthread_getattr_default_np(&before_);
        pthread_getattr_default_np(&none);
        pthread_attr_setstacksize(&none, std::size_t{1} << 50);
        pthread_setattr_default_np(&none);
        pthread_attr_destroy(&none);
    }
    NoMoreThreads(NoMoreThreads const&) = delete;
    NoMoreThreads& operator=(NoMoreThreads const&) = delete;
    ~NoMoreThreads() {
        pthread_setattr_default_np(&before_);
        pthread_attr_destroy(&before_);
    }

  private:
    pthread_attr_t before_;
};

}  // namespace catena::test
