// Implements the request made by the environment variable CATENA_HDF5.
#include <cstdlib>
#include <span>

#include "error.hpp"
#include "io/parallel_io_mode.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"

namespace catena {

RequestedIoMode file_wish(std::string const& word) {
    if (word.empty()) return RequestedIoMode::best;
    if (word == "root") return RequestedIoMode::root;
    if (word == "collective") return RequestedIoMode::collective;
    throw InputError("not a way to write files: " + word, "CATENA_HDF5",
                     "use root or collective, or leave it out");
}

RequestedIoMode requested_io_mode_of_run(Communicator const& communicator) {
    RequestedIoMode wish = RequestedIoMode::best;
    on_first_rank(communicator, [&] {
        char const* const word = std::getenv("CATENA_HDF5");
        wish = file_wish(word != nullptr ? word : "");
    });
    broadcast(communicator, wish);
    return wish;
}

}  // namespace catena
