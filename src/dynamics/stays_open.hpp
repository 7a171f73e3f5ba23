// What Closing::close() throws.
#pragma once

#include "error.hpp"

namespace catena {

/// No number of sweeps closes a drift's joints. On all ranks alike.
class StaysOpen : public ComputationError {
  public:
    using ComputationError::ComputationError;
};

}  // namespace catena
