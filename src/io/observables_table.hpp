// Reader of observables.csv for the run report.
#pragma once

#include <string>
#include <vector>

namespace catena {

/// Columns of a table of observables.
struct ObservablesTable {
    std::vector<std::string> names;            // "step", "time [ps]", "total_energy [kJ/mol]", ...
    std::vector<std::vector<double>> columns;  // one for each name
};

/// Reads a table that ObservablesWriter wrote. Throws InputError naming file and line for any other
/// contents. A last line without a line end is ignored.
ObservablesTable read_observables(std::string const& file);

}  // namespace catena
