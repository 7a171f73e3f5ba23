// Binds the declared keys of scenes, and what launched this process.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "keys/maps.hpp"
#include "mpi/launcher.hpp"

namespace catena::python {
namespace {

/// Returns place of the map, name and unit in words of each key that has a unit.
std::vector<std::tuple<std::string, std::string, std::string>> units_of_keys() {
    std::vector<std::tuple<std::string, std::string, std::string>> units;
    for (scene::KeyMap const* const map : scene::keys::all())
        for (scene::Key const& key : map->keys)
            if (!key.unit.empty())
                units.emplace_back(std::string(map->place), std::string(key.name),
                                   std::string(key.unit));
    return units;
}

/// Returns rank and number of processes that a launcher such as mpirun started, and its variable.
std::tuple<int, int, std::string> launched() {
    Launch const launch = launch_environment();
    return {launch.rank, launch.size, launch.evidence};
}

}  // namespace

void add_keys(nanobind::module_& module) {
    module.def("units_of_keys", &units_of_keys);
    module.def("launched", &launched);
}

}  // namespace catena::python
