// Exception of Closing::close().
#pragma once

#include "error.hpp"

namespace catena {

/// Thrown on all ranks alike if no number of sweeps closes a drift's joints.
class ClosingFailure : public ComputationError {
  public:
    using ComputationError::ComputationError;
};

}  // namespace catena
