// Writers of all ranks, by parallel HDF5. A write that fails on one rank leaves the other ranks
// waiting within HDF5, and at times that rank as well. MPI reports the failure before HDF5 does,
// and the program ends there. The failure to be expected, a full disk, is therefore tested
// beforehand. Rank 0 reserves the space of a frame or a checkpoint before any rank writes, so that
// all ranks end in good order.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <thread>
#include <vector>

#include "io/descriptor.hpp"
#include "io/writers.hpp"
#include "mpi/first_rank.hpp"
#include "mpi/mpi_handles.hpp"

namespace catena::hdf5 {
namespace {

/// True if MPI's file layer does not report failed writes: OMPIO, Open MPI's own (4.1). Open MPI's
/// alternative is ROMIO, which other MPI libraries use too (mpi_communicator.cpp).
bool is_quiet_about_failures() {
    if (!message_passing_library().starts_with("Open MPI")) return false;
    char const* const chosen = std::getenv("OMPI_MCA_io");
    std::string_view const word = chosen != nullptr ? chosen : "";
    return !word.starts_with("romio") &&
           !(word.starts_with("^") && word.find("ompio") != word.npos);
}

/// Files whose failure ends the program, as long as their writers exist.
struct Watched {
    void const* owner;
    MPI_File file;
    Communicator const* communicator;
    std::string what;
};
std::vector<Watched>& watched() {
    static std::vector<Watched> all;
    return all;
}

/// MPI error handler that prints the failure and ends all ranks. Rank 0 prints first. The other
/// ranks wait 10 s, so that they are ended before they print, even on a busy machine.
void end_all(MPI_File* file, int* code, ...) {  // NOLINT(cert-dcl50-cpp): MPI's signature
    char text[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    MPI_Error_string(*code, text, &length);
    auto const failed = std::find_if(watched().rbegin(), watched().rend(),
                                     [&](Watched const& one) { return one.file == *file; });
    if (failed == watched().rend()) {
        std::fprintf(stderr, "catena: cannot write a file: %s\n", text);
        MPI_Abort(MPI_COMM_WORLD, 1);
        std::_Exit(1);
    }
    if (failed->communicator->rank() != 0) std::this_thread::sleep_for(std::chrono::seconds(10));
    std::fprintf(stderr, "catena: %s: %s\n", failed->what.c_str(), text);
    failed->communicator->abort(1);
}

/// Collective access to a file by MPI-IO (H5FD_MPIO_COLLECTIVE).
class AllWriters final : public Writers {
  public:
    explicit AllWriters(Communicator const& communicator)
        : communicator_(communicator), transfer_(H5Pcreate(H5P_DATASET_XFER)) {
        if (!transfer_ || H5Pset_dxpl_mpio(transfer_.get(), H5FD_MPIO_COLLECTIVE) < 0)
            throw ComputationError("cannot write together: " + cause());
    }
    AllWriters(AllWriters const&) = delete;
    AllWriters& operator=(AllWriters const&) = delete;
    ~AllWriters() override {
        std::erase_if(watched(), [&](Watched const& one) { return one.owner == this; });
    }
    bool are_several() const override { return true; }
    bool is_first() const override { return communicator_.rank() == 0; }
    void prepare(Properties const& access, std::string const& file,
                 std::string const& doing) const override {
        check(H5Pset_fapl_mpio(access.get(), handle_of(communicator_), MPI_INFO_NULL), file, doing);
        check(H5Pset_coll_metadata_write(access.get(), true), file, doing);
    }
    void watch(File const& handle, std::string const& file, std::string const& doing) override {
        void* opened = nullptr;
        check(H5Fget_vfd_handle(handle.get(), H5P_DEFAULT, &opened), file, doing);
        MPI_File const file_of_mpi = *static_cast<MPI_File const*>(opened);
        watched().push_back(
            {this, file_of_mpi, &communicator_, "cannot " + doing + " (" + file + ")"});
        MPI_Errhandler handler = MPI_ERRHANDLER_NULL;
        check_mpi(MPI_File_create_errhandler(end_all, &handler), "MPI_File_create_errhandler");
        check_mpi(MPI_File_set_errhandler(file_of_mpi, handler), "MPI_File_set_errhandler");
        check_mpi(MPI_Errhandler_free(&handler), "MPI_Errhandler_free");
    }
    hid_t transfer() const override { return transfer_.get(); }
    std::int64_t sum(std::int64_t value) const override { return communicator_.sum(value); }

    void make_room(File const&, hsize_t more, std::string const& file,
                   std::string const& doing) override {
        grown_ += static_cast<off_t>(more);
        on_first_rank(communicator_, [&] { reserve(file, doing); });
    }
    void flush_to_disk(File const& handle, std::string const& file,
                       std::string const& doing) const override {
        check(H5Fflush(handle.get(), H5F_SCOPE_LOCAL), file, doing);  // includes MPI_File_sync
    }
    /// Returns false. Metadata exist only in HDF5's memory, and data of frames that no metadata
    /// mention are harmless. A file that is never closed thus stays as it is.
    bool leave_as_flushed(File const&) const override { return false; }

  private:
    /// Reserves disk space up to the expected length of the file. Rank 0 only.
    void reserve(std::string const& file, std::string const& doing) {
        Descriptor const opened(file, O_RDWR, file, doing);
        // Parallel HDF5 does not report how long the file will be. Its initial length is the one
        // that the root left.
        if (reserved_ == 0) reserved_ = first_ = ::lseek(opened.get(), 0, SEEK_END);
        off_t const wanted = first_ + grown_ + grown_ / 64 +
                             (16 << 10);  // metadata: 100 bytes per chunk of at least 8 kB
        if (wanted <= reserved_) return;
        refuse_beyond_limit(wanted, file, doing);
        take_from_system(opened.get(), reserved_, wanted - reserved_, file, doing);
        reserved_ = wanted;
    }

    Communicator const& communicator_;
    Properties transfer_;
    off_t first_ = 0, grown_ = 0,
          reserved_ = 0;  // bytes: initial length, frames since then, reserved on disk
};

}  // namespace

std::string why_not_by_all(Communicator const& communicator) {
    if (handle_of(communicator) == MPI_COMM_NULL) return "these ranks are not MPI's";
    return is_quiet_about_failures() ? "OMPIO does not report writes that fail (OMPI_MCA_io=^ompio)"
                                     : "";
}

std::unique_ptr<Writers> all_writers(Communicator const& communicator) {
    return std::make_unique<AllWriters>(communicator);
}

}  // namespace catena::hdf5
