// Picture of timeline.json: bars that show the phases of one step on every rank.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace catena {

/// Returns the picture as HTML, or "" if nothing was recorded. `timeline`: {"ranks": [{"rank": r,
/// "steps": [{"step": n, "phases": [{"name", "lane", "begin", "end"}, ...]}]}]}. Times are seconds
/// on a clock that ranks need not share: each rank's bars start at its own first phase. The
/// recorded step of median length on the first rank is drawn. Throws nlohmann's exceptions for
/// other contents.
std::string timeline_picture(nlohmann::ordered_json const& timeline);

}  // namespace catena
