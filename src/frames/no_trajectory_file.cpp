// Replaces the reader of trajectories in a build without HDF5.
#include "error.hpp"
#include "frames/trajectory_file.hpp"

namespace catena {

struct TrajectoryFile::Series {};

TrajectoryFile::TrajectoryFile(std::string const& place, SiteOrder) {
    throw built_without("HDF5", "trajectory in " + place,
                        "install HDF5 (libhdf5-dev) and build again");
}
TrajectoryFile::~TrajectoryFile() = default;
void TrajectoryFile::read(std::size_t, Snapshot&) const {}

}  // namespace catena
