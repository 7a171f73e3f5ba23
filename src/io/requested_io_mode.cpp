#include <cstdlib>
#include <span>

#include "error.hpp"
#include "io/parallel_io_mode.hpp"
#include "mpi/first_rank.hpp"

namespace catena {

FileWish file_wish(std::string const& word) {
    if (word.empty()) return FileWish::best;
    if (word == "root") return FileWish::root;
    if (word == "collective") return FileWish::collective;
    throw InputError("no way to write files: " + word, "CATENA_HDF5", "say root or collective, or leave it out");
}

FileWish file_wish_of_run(Communicator const& communicator) {
    FileWish wish = FileWish::best;
    on_first_rank(communicator, [&] {
        char const* const word = std::getenv("CATENA_HDF5");
        wish = file_wish(word != nullptr ? word : "");
    });
    communicator.broadcast(std::as_writable_bytes(std::span(&wish, 1)));
    return wish;
}

}  // namespace catena
