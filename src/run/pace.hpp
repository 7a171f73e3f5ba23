// Speed of a run without its first steps.
#pragma once

#include <cstdint>

namespace catena {

/// Mean speed of the steps that count. The first steps build lists, allocate memory and compile
/// kernels, so that a short run's mean says little about a long one.
class Pace {
  public:
    /// Records the clock in seconds after each step. `steps`: steps so far; `from`: number of steps
    /// after which steps count.
    void note(std::int64_t steps, std::int64_t from, double now) {
        steps_ = steps;
        now_ = now;
        if (steps > from) return;
        from_ = steps;
        begun_ = now_;
    }
    /// Returns 0 if no steps counted yet.
    double steps_per_second() const {
        return steps_ > from_ && now_ > begun_
                   ? static_cast<double>(steps_ - from_) / (now_ - begun_)
                   : 0;
    }

  private:
    /// Last step recorded, and the last one that does not count.
    std::int64_t steps_ = 0, from_ = 0;
    /// Their times.
    double begun_ = 0, now_ = 0;
};

}  // namespace catena
