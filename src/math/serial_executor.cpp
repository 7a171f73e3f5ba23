// Executor that runs every loop on the calling thread.
#include "math/executor.hpp"

namespace catena {
namespace {

class SerialExecutor final : public Executor {
  public:
    using Executor::Executor;
    void for_ranges(std::int64_t count, int /*cost*/,
                    std::function<void(std::int64_t, std::int64_t)> const& body) const override {
        if (count > 0) body(0, count);
    }
    int threads() const override { return 1; }
};

}  // namespace

std::unique_ptr<Executor> serial_executor(SimdLevel simd) {
    return std::make_unique<SerialExecutor>(simd);
}

Executor const& this_thread() {
    static SerialExecutor const executor(best_simd_level());
    return executor;
}

}  // namespace catena
