// Decides whether the ranks can and should write an HDF5 file together.
#include "io/parallel_io_mode.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <span>

#include "error.hpp"
#include "io/writers.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"

namespace catena {
namespace {

/// Inode and size of a file, which are the same on every host that sees the same file.
using Marks = std::array<std::int64_t, 2>;

Marks marks_of(std::string const& file) {
    int const descriptor =
        ::open(file.c_str(), O_RDWR | O_CLOEXEC);  // open() asks the file server, if there is one
    if (descriptor < 0) return {-1, -1};
    struct stat status{};
    bool const told = ::fstat(descriptor, &status) == 0;
    ::close(descriptor);
    if (!told) return {-1, -1};
    return {static_cast<std::int64_t>(status.st_ino), static_cast<std::int64_t>(status.st_size)};
}

/// Returns the last rank whose host sees another file or none of that name, or -1. Collective.
int rank_without(Communicator const& communicator, std::string const& file) {
    Marks const own = marks_of(file);
    Marks of_root = own;
    broadcast(communicator, of_root);
    return static_cast<int>(communicator.max(own == of_root ? -1 : communicator.rank()));
}

/// True if the file system grants locks. MPI-IO locks files on many file systems and ends the
/// program if it cannot.
bool has_locks(std::string const& file) {
    int const descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
    struct flock lock{};
    lock.l_type = F_WRLCK, lock.l_whence = SEEK_SET, lock.l_len = 1;
    bool const locked = descriptor >= 0 && (::fcntl(descriptor, F_SETLK, &lock) == 0 ||
                                            errno == EAGAIN || errno == EACCES);
    if (descriptor >= 0) ::close(descriptor);
    return locked;
}

/// Reason why the root must write alone; empty if all ranks can write. Collective.
std::string why_by_the_root(Communicator const& communicator, std::string const& file) {
    std::string const why = hdf5::why_not_by_all(communicator);
    if (communicator.sum(why.empty() ? 0 : 1) > 0)
        return why.empty() ? "not every rank can write with the others" : why;
    int const rank = rank_without(communicator, file);
    if (rank >= 0) return "rank " + std::to_string(rank) + " does not see the file";
    return communicator.sum(has_locks(file) ? 0 : 1) > 0 ? "its file system has no locks" : "";
}

}  // namespace

ParallelIoMode by_the_root(std::string const& why) { return {false, "by the root: " + why, why}; }

ParallelIoMode choose_file_way(Communicator const& communicator, RequestedIoMode wish,
                               std::string const& file, std::int64_t bytes,
                               SmallWrites const& small) {
    if (communicator.size() == 1) return {};
    if (wish == RequestedIoMode::root) return by_the_root("CATENA_HDF5 says so");
    broadcast(communicator, bytes);
    if (wish == RequestedIoMode::best && bytes < small.below) return by_the_root(small.why);
    std::string const why = why_by_the_root(communicator, file);
    return why.empty() ? ParallelIoMode{true, "collective, " + std::to_string(communicator.size()) +
                                                  " ranks"}
                       : by_the_root(why);
}

std::string why_not_together(Communicator const& communicator,
                             std::initializer_list<std::function<void()>> steps) {
    try {
        for (auto const& step : steps) on_every_rank(communicator, step);
    } catch (std::runtime_error const& error) {
        return error.what();
    }
    return "";
}

void require_wished(RequestedIoMode wish, ParallelIoMode const& way, std::string const& file) {
    if (wish == RequestedIoMode::collective && !way.why_not.empty())
        throw InputError("ranks cannot write together, " + way.why_not, file,
                         "leave CATENA_HDF5=collective out: rank 0 then writes");
}

}  // namespace catena
