// How the ranks of a run write a file of HDF5's: the root alone, or all of them together.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>

#include "mpi/communicator.hpp"

namespace catena {

/// What CATENA_HDF5 wants: nothing (collective where that is possible), `root` or `collective` (of
/// frames an error where it is not).
enum class RequestedIoMode { best, root, collective };
/// InputError for other words.
RequestedIoMode file_wish(std::string const& word);
/// Of rank 0's environment: launchers bring variables to other hosts only when told to. Collective.
RequestedIoMode requested_io_mode_of_run(Communicator const&);

struct ParallelIoMode {
    bool collective = false;
    std::string text = "by the root";  // with the reason where several ranks might have; else
                                       // "collective, 3 ranks"
    std::string why_not = {};
};
ParallelIoMode by_the_root(std::string const& why);
/// For `file`, which the root has made, and so many bytes of `what` at once (the root knows): few
/// are sooner written by one. Collective.
ParallelIoMode choose_file_way(Communicator const&, RequestedIoMode, std::string const& file,
                               std::int64_t bytes, std::string const& what);
/// Has every rank do what brings it to a collective way, in steps: none begins before the one
/// before has succeeded on all. Empty; or why some rank cannot. Collective.
std::string why_not_together(Communicator const&,
                             std::initializer_list<std::function<void()>> steps);
/// InputError where collective writing was wished for and is not what became of it.
void require_wished(RequestedIoMode, ParallelIoMode const&, std::string const& file);

}  // namespace catena
