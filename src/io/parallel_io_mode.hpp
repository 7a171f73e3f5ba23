// Choice of who writes an HDF5 file: the root alone or all ranks together.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>

#include "mpi/communicator.hpp"

namespace catena {

/// Request made by CATENA_HDF5. best: variable unset, collective if possible; root; collective:
/// frames that cannot be written together are an error.
enum class RequestedIoMode { best, root, collective };
/// Parses the value of CATENA_HDF5. Throws InputError for unknown words.
RequestedIoMode file_wish(std::string const& word);
/// Reads CATENA_HDF5 from rank 0's environment: launchers pass variables to other hosts only on
/// request. Collective.
RequestedIoMode requested_io_mode_of_run(Communicator const&);

/// Mode in which a file is written.
struct ParallelIoMode {
    bool collective = false;           // all ranks write
    std::string text = "by the root";  // for the summary: with the reason if several ranks could
                                       // have written; else "collective, 3 ranks"
    std::string why_not = {};          // reason why ranks do not write together; may be empty
};
/// Mode of writing by the root, for the reason `why`.
ParallelIoMode by_the_root(std::string const& why);
/// Size in bytes below which the root writes, and why.
struct SmallWrites {
    std::int64_t below;
    std::string why;
};
/// Chooses the mode for `file`, which the root has created. `bytes`: size of one write, which the
/// root knows. Collective.
ParallelIoMode choose_file_way(Communicator const&, RequestedIoMode, std::string const& file,
                               std::int64_t bytes, SmallWrites const&);
/// Runs `steps` on every rank, a step only after the preceding one has succeeded on all ranks.
/// Returns an empty text, or the reason why some rank failed. Collective.
std::string why_not_together(Communicator const&,
                             std::initializer_list<std::function<void()>> steps);
/// Throws InputError if collective writing was requested but is not the mode.
void require_wished(RequestedIoMode, ParallelIoMode const&, std::string const& file);

}  // namespace catena
