// Worker: one thread that runs one task at a time.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace catena {

/// Thread on which OpenMM computes while the caller continues.
class Worker {
  public:
    Worker() : thread_([this] { serve(); }) {}
    /// Waits for the task in progress and joins the thread.
    ~Worker();
    Worker(Worker const&) = delete;
    Worker& operator=(Worker const&) = delete;

    /// Starts `task`, which must not throw. Precondition: no task is in progress.
    void post(std::function<void()> task);
    /// Blocks until no task is in progress.
    void wait();

  private:
    /// Runs posted tasks until the destructor asks it to stop.
    void serve();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::function<void()> task_;  // task in progress; empty if there is none
    bool leave_ = false;
    std::thread thread_;
};

}  // namespace catena
