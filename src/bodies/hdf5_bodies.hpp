// Reader of large chains of rigid bodies: `bodies: {hdf5: chain.h5}`.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace catena::scene {

/// Reads the bodies of the file `path` and their loads, block by block, into a chain;
/// inputs/keys/bodies.md lists its datasets. Every check of the YAML reader applies. A child
/// process reads the file first, because HDF5 crashes on many damaged files. Throws InputError that
/// names file, dataset and body. A build without HDF5 throws "built without HDF5".
ChainSpec read_hdf5_bodies(std::string const& path, Base base);

}  // namespace catena::scene
