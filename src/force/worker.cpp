// One thread that runs one task at a time.
#include "force/worker.hpp"

#include <utility>

namespace catena {

Worker::~Worker() {
    {
        std::lock_guard const lock(mutex_);
        leave_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Worker::post(std::function<void()> task) {
    {
        std::lock_guard const lock(mutex_);
        task_ = std::move(task);
    }
    changed_.notify_all();
}

void Worker::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !task_; });
}

void Worker::serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return leave_ || task_; });
        if (!task_) return;
        lock.unlock();
        task_();
        lock.lock();
        task_ = nullptr;
        changed_.notify_all();
    }
}

}  // namespace catena
