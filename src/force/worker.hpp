// One thread that runs one task at a time.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace catena {

class Worker {
  public:
    Worker() : thread_([this] { serve(); }) {}
    ~Worker();
    Worker(Worker const&) = delete;
    Worker& operator=(Worker const&) = delete;

    /// Hands over a task, which must not throw. Precondition: no task is under way.
    void post(std::function<void()> task);
    /// Returns when no task is under way.
    void wait();

  private:
    void serve();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::function<void()> task_;  // empty: nothing to do
    bool leave_ = false;
    std::thread thread_;
};

}  // namespace catena
