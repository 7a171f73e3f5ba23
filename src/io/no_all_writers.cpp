// Replaces all_writers.cpp in a build whose HDF5 is serial.
#include "error.hpp"
#include "io/writers.hpp"

namespace catena::hdf5 {

std::string why_not_by_all(Communicator const&) { return "this build's HDF5 is serial"; }

std::unique_ptr<Writers> all_writers(Communicator const& communicator) {
    throw ComputationError(why_not_by_all(communicator));
}

}  // namespace catena::hdf5
