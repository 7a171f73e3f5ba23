// Stub for accelerations_hdf5.cpp in a build without HDF5.
#include "error.hpp"
#include "measure/solution.hpp"

namespace catena {

void require_accelerations_writer(std::string const& file) {
    throw built_without("HDF5", "--accelerations " + file,
                        "install HDF5 (libhdf5-dev) and build again, or use --json");
}

void write_accelerations(std::string const& file, Solution const&) {
    require_accelerations_writer(file);
}

}  // namespace catena
