// Implements the words on long tasks by a thread that mostly sleeps. It allocates nothing, because
// an allocation of a second thread reserves much address space.
#include "console/long_task.hpp"

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <utility>

#include "io/printable.hpp"

namespace catena::command {

LongTask::LongTask(bool speaks, std::string what, std::chrono::milliseconds every)
    : what_(printable(what)), every_(every) {
    std::replace(what_.begin(), what_.end(), '\n', ' ');
    if (!speaks) return;
    try {
        thread_ = std::thread([this] { speak(); });
    } catch (std::system_error const&) {
        // Where no thread can be had the task is silent.
    }
}

LongTask::~LongTask() {
    {
        std::lock_guard const lock(mutex_);
        is_over_ = true;
    }
    ended_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void LongTask::speak() {
    auto const start = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    for (auto next = start + every_; !ended_.wait_until(lock, next, [this] { return is_over_; });
         next += every_) {
        std::chrono::duration<double> const past = next - start;
        std::fprintf(stderr, "catena: %s: %.3g s\n", what_.c_str(), past.count());
    }
}

}  // namespace catena::command
