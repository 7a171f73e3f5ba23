// Text on the net charges of chains. This header does not need OpenMM.
#pragma once

#include <span>
#include <string>

#include "systems/bead_system.hpp"

namespace catena {

/// Returns, e.g., "net charge: a -1.000 e, b 2.000 e; together 1.000 e". Consecutive chains of the
/// same charge are merged: "a to c -1.000 e each". `of_bead` holds the charges in e, in the order
/// of the beads.
std::string charge_text(std::span<double const> of_bead, BeadSystem const&);

}  // namespace catena
