// Large chains of rigid bodies: `bodies: {hdf5: chain.h5}`.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace catena::scene {

/// Reads `path`, whose datasets inputs/keys/bodies.md lists, row by row into the arrays, with every
/// check that the YAML reader makes. A child process reads it first: HDF5 breaks on many damaged
/// files. Throws InputError that names file, dataset and body; "built without HDF5".
BodyArrays read_hdf5_bodies(std::string const& path, Base base);

}  // namespace catena::scene
