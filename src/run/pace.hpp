// How quick a run is once its start is behind it.
#pragma once

#include <cstdint>

namespace catena {

/// First steps make lists, find memory and compile kernels: a short run's mean says little about a
/// long one.
class Pace {
  public:
    /// After each step: how many there have been, from which on they count, and the clock.
    void note(std::int64_t steps, std::int64_t from, double now) {
        steps_ = steps;
        now_ = now;
        if (steps > from) return;
        from_ = steps;
        begun_ = now_;
    }
    /// 0: there were none that count.
    double steps_per_second() const {
        return steps_ > from_ && now_ > begun_
                   ? static_cast<double>(steps_ - from_) / (now_ - begun_)
                   : 0;
    }

  private:
    std::int64_t steps_ = 0, from_ = 0;
    double begun_ = 0, now_ = 0;
};

}  // namespace catena
