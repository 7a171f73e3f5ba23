// Replaces hdf5_bodies.cpp in a build without HDF5.
#include "bodies/hdf5_bodies.hpp"
#include "error.hpp"

namespace catena::scene {

ChainSpec read_hdf5_bodies(std::string const& path, Base) {
    throw built_without(
        "HDF5", "bodies " + path,
        "install HDF5 (libhdf5-dev) and build again, or write the bodies as a list");
}

}  // namespace catena::scene
