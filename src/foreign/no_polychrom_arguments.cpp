// Replaces polychrom_arguments.cpp in a build without HDF5.
#include "error.hpp"
#include "foreign/known_tools.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

Settings polychrom_settings(Files const& files) {
    throw built_without("HDF5", scene::shown_path(files.init_args),
                        "move the file out of the folder and set the dynamics yourself");
}

}  // namespace catena::foreign
