// Where loops over independent items run. Results never depend on it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "math/simd_level.hpp"

namespace catena {

class Executor {
  public:
    explicit Executor(SimdLevel simd) : simd_(simd) {}
    virtual ~Executor() = default;
    /// Calls body(begin, end) on ranges that together cover [0, count) once. The calls may run side
    /// by side, where that pays: one of `count` costs as much as `cost` single bodies, merges or
    /// runs do.
    virtual void for_ranges(std::int64_t count, int cost,
                            std::function<void(std::int64_t, std::int64_t)> const& body) const = 0;
    virtual int threads() const = 0;
    /// Of each thread, where several items go side by side.
    SimdLevel simd() const { return simd_; }

    template <class Item>
    void for_each(std::int64_t count, Item const& item) const {
        for_ranges(count, 1, [&item](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) item(i);
        });
    }
    /// item(i, executor for its own loops over single things): many items run side by side, of few
    /// each has all threads. Threads start once then, not once an item.
    template <class Item>
    void for_each_of_many_or_few(std::int64_t count, Item const& item) const;

  private:
    SimdLevel simd_;
};

std::unique_ptr<Executor> serial_executor(SimdLevel = best_simd_level());
/// One of those, for as long as the program runs.
Executor const& this_thread();

template <class Item>
void Executor::for_each_of_many_or_few(std::int64_t count, Item const& item) const {
    constexpr int as_bodies = 64;  // an item costs so much at least
    if (count < threads())
        for (std::int64_t i = 0; i < count; ++i) item(i, *this);
    else
        for_ranges(count, as_bodies, [&item](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) item(i, this_thread());
        });
}
/// `threads` OpenMP threads. Throws "built without OpenMP" where it is absent.
std::unique_ptr<Executor> openmp_executor(int threads, SimdLevel = best_simd_level());
bool openmp_is_built();

}  // namespace catena
