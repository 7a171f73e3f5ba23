// Stub for accelerations_hdf5.cpp in a build without HDF5.
#include "error.hpp"
#include "measure/accelerations_file.hpp"

namespace catena {

void require_accelerations_hdf5(std::string const& file) {
    throw built_without("HDF5", "--accelerations " + file,
                        "install HDF5 (libhdf5-dev) and build again, or name a .csv or .json file");
}

void write_accelerations_hdf5(std::string const& file, Solution const&) {
    require_accelerations_hdf5(file);
}

}  // namespace catena
