// Replaces the writer of contact maps in a build without HDF5, which reads no trajectory either.
#include "analysis/analysis.hpp"
#include "error.hpp"

namespace catena::analysis {

void write_maps(Analysis const&, std::string const& file) {
    throw built_without("HDF5", file, "install HDF5 (libhdf5-dev) and build again");
}

}  // namespace catena::analysis
