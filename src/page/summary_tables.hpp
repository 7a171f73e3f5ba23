// summary.json as tables: numbers of the top level together, every object a table of its own.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace catena {

std::string summary_tables(nlohmann::ordered_json const& summary);

}  // namespace catena
