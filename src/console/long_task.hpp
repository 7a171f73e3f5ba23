// Words on standard error for tasks that take long, so that nobody takes them for hung.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace catena::command {

/// Says "catena: WHAT: 20 s" on standard error every 20 s from its construction to its end.
class LongTask {
  public:
    /// `speaks` is false on ranks that say nothing, and where --quiet is given.
    LongTask(bool speaks, std::string what,
             std::chrono::milliseconds every = std::chrono::seconds(20));
    ~LongTask();
    LongTask(LongTask const&) = delete;
    LongTask& operator=(LongTask const&) = delete;

  private:
    void speak();

    std::string what_;
    std::chrono::milliseconds every_;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool is_over_ = false;
    std::thread thread_;
};

}  // namespace catena::command
