// Times of sweeps for a solver's report.
#pragma once

#include "clock.hpp"

namespace catena::dca {

/// Adds the seconds of its lifetime to a sweep's. If the space does not wait for its work, it does
/// so only while measurement is on.
template <class Space>
class SweepTimer {
  public:
    SweepTimer(Space const& space, bool measured, double& seconds)
        : space_(space), measured_(measured), seconds_(seconds), start_(seconds_now()) {}
    ~SweepTimer() {
        if (measured_) space_.wait();
        if (measured_ || Space::answers_at_once) seconds_ += seconds_now() - start_;
    }
    SweepTimer(SweepTimer const&) = delete;
    SweepTimer& operator=(SweepTimer const&) = delete;

  private:
    Space const& space_;
    bool measured_;
    double& seconds_;
    double start_;
};

}  // namespace catena::dca
