// timeline.json as bars: who worked on what during one step.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace catena {

/// `timeline`: {"ranks": [{"rank": r, "steps": [{"step": n, "phases": [{"name", "lane", "begin",
/// "end"}, ...]}]}]}, seconds on a clock that the ranks need not share: each rank's bars start at
/// its own first phase. Drawn is the recorded step of median length on the first rank. "" when
/// nothing was recorded. Throws nlohmann's exceptions for another shape.
std::string timeline_picture(nlohmann::ordered_json const& timeline);

}  // namespace catena
