// Executor that runs loops on OpenMP threads.
#include <algorithm>
#include <exception>

#include "math/executor.hpp"

namespace catena {
namespace {

/// Smallest work per thread, in merges: starting threads costs as much as some tens of merges.
constexpr std::int64_t worth_a_thread = 64;

class OpenMpExecutor final : public Executor {
  public:
    OpenMpExecutor(int threads, SimdLevel simd) : Executor(simd), threads_(threads) {}

    void for_ranges(std::int64_t count, int cost,
                    std::function<void(std::int64_t, std::int64_t)> const& body) const override {
        if (count <= 0) return;
        std::int64_t const ranges =
            std::min<std::int64_t>({count * cost / worth_a_thread, count, threads_});
        if (ranges <= 1) return body(0, count);
        // Exceptions must not leave a parallel region: the last one caught is thrown again after
        // it.
        std::exception_ptr error;
#pragma omp parallel for num_threads(threads_) schedule(static, 1)
        for (std::int64_t i = 0; i < ranges; ++i) try {
                body(count * i / ranges, count * (i + 1) / ranges);
            } catch (...) {
#pragma omp critical
                error = std::current_exception();
            }
        if (error) std::rethrow_exception(error);
    }
    int threads() const override { return threads_; }

  private:
    int threads_;
};

}  // namespace

bool openmp_is_built() { return true; }

std::unique_ptr<Executor> openmp_executor(int threads, SimdLevel simd) {
    return std::make_unique<OpenMpExecutor>(std::max(threads, 1), simd);
}

}  // namespace catena
