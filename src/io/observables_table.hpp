// observables.csv read back, for the report.
#pragma once

#include <string>
#include <vector>

namespace catena {

struct ObservablesTable {
    std::vector<std::string> names;            // "step", "time [ps]", "total_energy [kJ/mol]", ...
    std::vector<std::vector<double>> columns;  // one for each name
};

/// InputError naming file and line for anything but a table of ObservablesWriter; a last line
/// without its end is left out.
ObservablesTable read_observables(std::string const& file);

}  // namespace catena
