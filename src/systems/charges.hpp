// The net charge of chains, for people. No OpenMM here.
#pragma once

#include <span>
#include <string>

#include "systems/bead_system.hpp"

namespace catena {

/// "net charge: a -1.000 e, b 2.000 e; together 1.000 e". Chains of one charge after the other
/// stand together: "a to c -1.000 e each". `of_bead`: in e, in the order of the beads.
std::string charge_text(std::span<double const> of_bead, BeadSystem const&);

}  // namespace catena
