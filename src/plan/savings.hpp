// What a scene does not need and is therefore not computed, and what that saves.
#pragma once

#include <functional>

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "integrate/chain_system.hpp"
#include "plan/family.hpp"

namespace catena::command {

struct Savings {
    std::string text;
    std::size_t share = 0;  // of plan::shares_of: the chains that do without
    /// Seconds that it would take of one evaluation of so many bodies; none: not measured.
    std::function<double(std::int64_t bodies)> takes = {};
};
std::vector<Savings> left_out(Scene const&, ChainSystem const&);

/// Each with the time that it saves in one evaluation: chains like the scene's, with it and
/// without, on one core. Collective.
void add_savings(Text&, Json&, Scene const&, ChainSystem const&);

}  // namespace catena::command
