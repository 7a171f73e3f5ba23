// Executors of loops over independent items on the host. Results never depend on the executor.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "math/simd_level.hpp"

namespace catena {

/// Interface of loop executors: serial or OpenMP threads.
class Executor {
  public:
    explicit Executor(SimdLevel simd) : simd_(simd) {}
    virtual ~Executor() = default;
    /// Calls body(begin, end) on disjoint ranges that together cover [0, count). The calls may run
    /// concurrently if that pays: one of the `count` items costs as much as `cost` single bodies,
    /// merges or runs.
    virtual void for_ranges(std::int64_t count, int cost,
                            std::function<void(std::int64_t, std::int64_t)> const& body) const = 0;
    /// Number of threads that for_ranges() may use.
    virtual int threads() const = 0;
    /// Instruction set with which each thread processes several items at once.
    SimdLevel simd() const { return simd_; }

    /// Calls item(i) for every i in [0, count), possibly concurrently.
    template <class Item>
    void for_each(std::int64_t count, Item const& item) const {
        for_ranges(count, 1, [&item](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) item(i);
        });
    }
    /// Calls item(i, executor) for every i in [0, count); `executor` is for the item's inner loops.
    /// Many items run concurrently, each on one thread; few items run one after the other, each
    /// with all threads. Threads are thus started once, not once per item.
    template <class Item>
    void for_each_of_many_or_few(std::int64_t count, Item const& item) const;

  private:
    SimdLevel simd_;
};

/// Returns an executor that runs every loop on the calling thread.
std::unique_ptr<Executor> serial_executor(SimdLevel = best_simd_level());
/// Returns a serial executor with static storage duration.
Executor const& this_thread();

template <class Item>
void Executor::for_each_of_many_or_few(std::int64_t count, Item const& item) const {
    // Assumed minimum cost of an item, in single bodies.
    constexpr int as_bodies = 64;
    if (count < threads())
        for (std::int64_t i = 0; i < count; ++i) item(i, *this);
    else
        for_ranges(count, as_bodies, [&item](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) item(i, this_thread());
        });
}
/// Returns an executor of `threads` OpenMP threads. Throws "built without OpenMP" if the build
/// lacks OpenMP.
std::unique_ptr<Executor> openmp_executor(int threads, SimdLevel = best_simd_level());
/// True if this build contains the OpenMP executor.
bool openmp_is_built();

}  // namespace catena
