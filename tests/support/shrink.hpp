// A chain on which something fails, made smaller and plainer as long as it still fails.
#pragma once

#include <functional>
#include <string>

#include "scene/scene.hpp"

namespace catena::test {

struct Shrunk {
    ChainSpec chain;
    std::string description;  // one line a body: type, state, loads
};

/// Precondition: `holds(chain)` is false. Tries to drop bodies from the tip and from the base
/// (halves first, then one by one) and to zero loads, velocities, springs, drag and drives, each as
/// a whole, and keeps every change under which `holds` stays false. Coordinates, masses and shapes
/// stay as they are. `holds` may throw: that counts as failing. A jointed tip moves inboard with
/// the last body and velocities are made to fit it, with driven joints as they are at `time`.
Shrunk shrink(ChainSpec const& chain, std::function<bool(ChainSpec const&)> const& holds,
              double time = 0);

/// The chain in lines that a person can read.
std::string describe(ChainSpec const& chain);

}  // namespace catena::test
