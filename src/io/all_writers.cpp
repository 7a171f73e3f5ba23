// All ranks by parallel HDF5. What one of them meets in the middle of a call, the others do not know of, and wait there: such a failure has
// to end the program (mpi/first_rank.hpp tells the two kinds apart). So the failure to be expected, a full disk, is looked for before: rank
// 0 takes the room for a frame from the system before anybody writes.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "io/writers.hpp"
#include "mpi/first_rank.hpp"
#include "mpi/mpi_handles.hpp"

namespace catena::hdf5 {
namespace {

class AllWriters final : public Writers {
  public:
    explicit AllWriters(Communicator const& communicator) : communicator_(communicator), transfer_(H5Pcreate(H5P_DATASET_XFER)) {
        if (!transfer_ || H5Pset_dxpl_mpio(transfer_.get(), H5FD_MPIO_COLLECTIVE) < 0)
            throw ComputationError("cannot write together: " + cause());
    }
    bool are_several() const override { return true; }
    bool is_first() const override { return communicator_.rank() == 0; }
    void prepare(Properties const& access, std::string const& file, std::string const& doing) const override {
        check(H5Pset_fapl_mpio(access.get(), handle_of(communicator_), MPI_INFO_NULL), file, doing);
        check(H5Pset_coll_metadata_write(access.get(), true), file, doing);
    }
    hid_t transfer() const override { return transfer_.get(); }
    std::int64_t sum(std::int64_t value) const override { return communicator_.sum(value); }

    void make_room(File const&, hsize_t more, std::string const& file, std::string const& doing) override {
        grown_ += static_cast<off_t>(more);
        on_first_rank(communicator_, [&] { reserve(file, doing); });
    }
    void flush_to_disk(File const& handle, std::string const& file, std::string const& doing) const override {
        check(H5Fflush(handle.get(), H5F_SCOPE_LOCAL), file, doing);  // MPI_File_sync is part of it
    }
    /// Metadata are in HDF5's memory alone, data of frames that they do not tell of harm nobody: what is never closed stays as it is.
    bool leave_as_flushed(File const&) const override { return false; }

  private:
    void reserve(std::string const& file, std::string const& doing) {
        int const descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
        if (descriptor < 0) throw ComputationError("cannot " + doing + " (" + file + "): " + std::strerror(errno));
        // Parallel HDF5 does not tell how long the file is to be. At first it is as the root left it.
        if (reserved_ == 0) reserved_ = first_ = ::lseek(descriptor, 0, SEEK_END);
        off_t const wanted = first_ + grown_ + grown_ / 64 + (16 << 10);  // with metadata: 100 bytes a chunk of 8 kB and more
        int const error = wanted <= reserved_ || fallocate(descriptor, FALLOC_FL_KEEP_SIZE, reserved_, wanted - reserved_) == 0 ? 0 : errno;
        ::close(descriptor);
        if (error == ENOSPC || error == EDQUOT || error == EFBIG)
            throw ComputationError("cannot " + doing + " (" + file + "): " + std::strerror(error));
        reserved_ = std::max(reserved_, wanted);  // or a file system that cannot: there the writes tell
    }

    Communicator const& communicator_;
    Properties transfer_;
    off_t first_ = 0, grown_ = 0, reserved_ = 0;  // bytes: at first, of frames since, taken from the system
};

}  // namespace

std::string why_not_by_all(Communicator const& communicator) {
    return handle_of(communicator) == MPI_COMM_NULL ? "these ranks are not MPI's" : "";
}

std::unique_ptr<Writers> all_writers(Communicator const& communicator) { return std::make_unique<AllWriters>(communicator); }

}  // namespace catena::hdf5
