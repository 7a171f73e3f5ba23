// Tables of summary.json: one for the values of the top level, and one for every object.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace catena {

/// Returns the tables as HTML. Empty values are omitted; lists of objects become tables with one
/// row per object.
std::string summary_tables(nlohmann::ordered_json const& summary);

}  // namespace catena
