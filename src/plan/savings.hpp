// Finds computations that a scene does not need, and measures what leaving them out saves.
#pragma once

#include <functional>

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "integrate/chain_system.hpp"
#include "plan/family.hpp"

namespace catena::command {

/// One computation that is left out.
struct Savings {
    std::string text;
    /// Index into plan::shares_of() of the chains that need no such computation.
    std::size_t share = 0;
    /// Returns the seconds that it would take in one evaluation of a number of bodies; empty if not
    /// measured.
    std::function<double(std::int64_t bodies)> takes = {};
};
/// Returns the computations that are left out for this scene and system.
std::vector<Savings> left_out(Scene const&, ChainSystem const&);

/// Adds each computation that is left out with the time it saves per evaluation. Chains like the
/// scene's are timed with and without it on one core. Collective.
void add_savings(Text&, Json&, Scene const&, ChainSystem const&);

}  // namespace catena::command
