// How the ranks of a run write a file of HDF5's: the root alone, or all of them together.
#pragma once

#include <cstdint>
#include <string>

#include "mpi/communicator.hpp"

namespace catena {

/// What CATENA_HDF5 wants: nothing (collective where that is possible), `root` or `collective` (an error where it is not).
enum class FileWish { best, root, collective };
/// InputError for other words.
FileWish file_wish(std::string const& word);
/// Of rank 0's environment: launchers bring variables to other hosts only when told to. Collective.
FileWish file_wish_of_run(Communicator const&);

struct FileWay {
    bool collective = false;
    std::string text = "by the root";  // with the reason where several ranks might have; else "collective, 3 ranks"
};
/// For `file`, which the root has made, and frames of so many bytes (the root knows): small ones are sooner written by one. InputError
/// where what is wished for cannot be. Collective.
FileWay choose_file_way(Communicator const&, FileWish, std::string const& file, std::int64_t bytes);

}  // namespace catena
