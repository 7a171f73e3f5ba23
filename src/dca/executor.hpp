// Where loops over independent items run. Results never depend on it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace catena {

class Executor {
  public:
    virtual ~Executor() = default;
    /// Calls body(begin, end) on ranges that together cover [0, count) once. The calls may run side by side.
    virtual void for_ranges(std::int64_t count, std::function<void(std::int64_t, std::int64_t)> const& body) const = 0;
    virtual int threads() const = 0;

    template <class Item>
    void for_each(std::int64_t count, Item const& item) const {
        for_ranges(count, [&item](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) item(i);
        });
    }
};

std::unique_ptr<Executor> serial_executor();
/// `threads` OpenMP threads. Throws "built without OpenMP" where it is absent.
std::unique_ptr<Executor> openmp_executor(int threads);
bool openmp_is_built();

}  // namespace catena
