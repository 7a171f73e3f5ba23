// Writer of checkpoints, by the root alone or by all ranks together.
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <utility>

#include "error.hpp"
#include "io/checkpoint_file.hpp"
#include "io/file_seal.hpp"
#include "io/output_file.hpp"
#include "io/writers.hpp"
#include "mpi/first_rank.hpp"

namespace catena {
namespace {

using namespace hdf5;

/// Makes `previous` a second name of the existing file, so that a checkpoint exists at every
/// moment.
void keep_previous(std::string const& file) {
    std::string const previous = previous_checkpoint(file), spare = previous + ".writing";
    ::unlink(spare.c_str());
    if (!std::filesystem::exists(file)) return;
    // A run that ended between the two renames left both names for one file.
    if (std::filesystem::exists(previous) && std::filesystem::equivalent(file, previous)) return;
    if (::link(file.c_str(), spare.c_str()) == 0) return rename_file(spare, previous);
    rename_file(file, previous);  // a file system without hard links
}

/// Smallest arrays in bytes that all ranks write together: what ranks send to the root in one piece
/// (chain/scene_windows.hpp). Collective writing of less takes 0.15 ms longer, and tens of ms if
/// ranks share cores.
constexpr std::int64_t smallest_shared = 4 << 20;

/// Sum over all ranks modulo 2^64. The halves are summed separately, so that they do not overflow.
std::uint64_t sum_over(Communicator const& communicator, std::uint64_t value) {
    auto const low = static_cast<std::uint64_t>(
        communicator.sum(static_cast<std::int64_t>(value & 0xffffffffU)));
    auto const high =
        static_cast<std::uint64_t>(communicator.sum(static_cast<std::int64_t>(value >> 32)));
    return low + (high << 32);
}

/// Bytes of all elements.
std::int64_t bytes_of(ArraySizes const& sizes) {
    std::int64_t bytes = 0;
    for (auto const& [name, size] : sizes)
        bytes += size * static_cast<std::int64_t>(sizeof(double));
    return bytes;
}

}  // namespace

/// Checkpoint that is being written under the temporary name `name`. Messages name the final
/// `file`.
struct CheckpointWriter::Draft {
    Communicator const& communicator;
    std::string file, name;
    Checkpoint head;              // arrays are empty
    ArraySizes later, sizes;      // arrays written by put(); all arrays
    std::uint64_t of_values = 0;  // checksum of this rank's elements
    ParallelIoMode way;
    std::unique_ptr<Writers> writers;  // null on ranks that do not write
    File handle;
    std::map<std::string, Dataset> data;
    std::exception_ptr failure;  // failure of put() on the root that writes alone
    bool is_finished = false;
    int to_other_host = 0;  // distance to the rank whose share this rank verifies: on another host
                            // if ranks are numbered host by host

    Draft(Communicator const& of, std::string const& written, Checkpoint const& checkpoint,
          ArraySizes const& by_put)
        : communicator(of),
          file(written),
          name(written + ".writing"),
          head{checkpoint.step,  checkpoint.time,     checkpoint.scene_hash,
               checkpoint.notes, checkpoint.integers, {}},
          later(by_put),
          sizes(by_put) {
        for (auto const& [array, values] : checkpoint.arrays) {
            sizes[array] = std::ssize(values);
            if (is_first()) of_values += checksum_of_values(array, 0, values);
        }
    }
    Draft(Draft const&) = delete;
    Draft& operator=(Draft const&) = delete;
    ~Draft() {
        if (way.collective) leave_open();
        if (!is_finished && is_first()) ::unlink(name.c_str());
    }
    bool is_first() const { return communicator.rank() == 0; }

    /// Opens the file and the datasets of the arrays `later`.
    void open(std::unique_ptr<Writers> by) {
        writers = std::move(by);
        Properties const access(check(H5Pcreate(H5P_FILE_ACCESS), file, writing_checkpoint));
        writers->prepare(access, file, writing_checkpoint);
        handle = File(
            check(H5Fopen(name.c_str(), H5F_ACC_RDWR, access.get()), file, writing_checkpoint));
        writers->watch(handle, file, writing_checkpoint);
        for (auto const& [array, size] : later)
            data[array] = open_array({handle.get(), file, writing_checkpoint}, array);
    }
    /// Leaves all objects open. The other ranks may not know that this rank stops here, and closing
    /// is collective.
    void leave_open() {
        for (auto& [array, dataset] : data) dataset.release();
        data.clear();
        handle.release();
    }
    /// Writes parts of an array and adds them to the checksum.
    void put(std::string const& array, std::span<ArrayPart const> parts) {
        Dataset const& dataset = data.at(array);
        Space const in_file(check(H5Dget_space(dataset.get()), file, writing_checkpoint));
        check(H5Sselect_none(in_file.get()), file, writing_checkpoint);
        std::vector<double> joined;
        hsize_t numbers = 0;
        for (ArrayPart const& part : parts) {
            if (part.values.empty()) continue;
            hsize_t const first = static_cast<hsize_t>(part.first), count = part.values.size();
            check(
                H5Sselect_hyperslab(in_file.get(), H5S_SELECT_OR, &first, nullptr, &count, nullptr),
                file, writing_checkpoint);
            if (parts.size() > 1)
                joined.insert(joined.end(), part.values.begin(), part.values.end());
            of_values += checksum_of_values(array, part.first, part.values);
            numbers += count;
        }
        Space const in_memory(
            check(H5Screate_simple(1, &numbers, nullptr), file, writing_checkpoint));
        double const* const values = parts.size() == 1 ? parts[0].values.data() : joined.data();
        check(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, in_memory.get(), in_file.get(),
                       writers->transfer(), values),
              file, writing_checkpoint);
    }
    /// Closes the file after a flush to disk.
    void close() {
        for (auto& [array, dataset] : data) check(dataset.close(), file, writing_checkpoint);
        writers->flush_to_disk(handle, file, writing_checkpoint);
        check(handle.close(), file, writing_checkpoint);
    }
    /// Calls look(reader) on the ranks that have the file, for the share of the rank `apart`
    /// further on.
    template <class Look>
    void share(int apart, Look const& look) const {
        on_every_rank(communicator, [&] {
            if (way.collective)
                look(Reader{(communicator.rank() + apart) % communicator.size(),
                            communicator.size()});
            else if (is_first())
                look(Reader{});
        });
    }
    /// Size and checksum of the sealed contents, each rank reading the share of the rank `apart`
    /// further on. Collective.
    Sealed sum_of_pieces(int apart) const {
        Sealed own;
        share(apart, [&](Reader reader) {
            own = sum_pieces(name, reader.number, reader.of, file, writing_checkpoint);
        });
        return {communicator.sum(own.bytes), sum_over(communicator, own.checksum)};
    }
    /// Writes the seal, then verifies that ranks see the same file. Collective.
    void seal() const {
        Sealed const sealed = sum_of_pieces(0);
        on_first_rank(communicator, [&] { put_seal(name, sealed, file, writing_checkpoint); });
        if (!way.collective) return;
        Sealed const again = sum_of_pieces(
            to_other_host);  // fails on a host that does not see yet what another one has written
        on_first_rank(communicator, [&] {
            if (again != sealed) refuse("ranks do not see the same file");
        });
    }
    /// Reopens the file and compares its checksum with its contents. Collective.
    void require_that_it_reads_back() const {
        CheckpointRead read;
        share(to_other_host, [&](Reader reader) {
            try {
                File const back(check(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), name,
                                      reading_checkpoint));
                read = read_checkpoint_file({back.get(), name, reading_checkpoint},
                                            Arrays::only_check, reader);
            } catch (std::exception const& error) {
                refuse(error.what());
            }
        });
        std::uint64_t const all = sum_over(communicator, read.of_values);
        on_first_rank(communicator, [&] {
            if (read.checksum != checksum_of(read.contents, read.sizes, all))
                refuse("its checksum does not match its contents");
        });
    }
    [[noreturn]] void refuse(std::string const& why) const {
        throw ComputationError("cannot write the checkpoint (" + file +
                               "): it does not read back, " + why);
    }
};

CheckpointWriter::CheckpointWriter(Communicator const& communicator, std::string const& file,
                                   Checkpoint const& checkpoint,
                                   std::map<std::string, std::int64_t> const& later) {
    Quiet const quiet;
    draft_ = std::make_unique<Draft>(communicator, file, checkpoint, later);
    Draft& draft = *draft_;
    on_first_rank(communicator, [&] { make_checkpoint_file(draft.name, file, checkpoint, later); });
    draft.way = choose_file_way(communicator, requested_io_mode_of_run(communicator), draft.name,
                                bytes_of(later), {smallest_shared, "arrays are small"});
    if (draft.way.collective) {
        std::unique_ptr<Writers> all;
        std::string const why = why_not_together(
            communicator,
            {[&] { all = all_writers(communicator); }, [&] { draft.open(std::move(all)); }});
        auto const of_host = static_cast<int>(communicator.max(communicator.ranks_on_host()));
        draft.to_other_host = of_host < communicator.size() ? of_host : 1;
        if (why.empty()) return;
        draft.leave_open();
        draft.writers.reset();
        draft.way = by_the_root(why);
    }
    on_first_rank(communicator, [&] { draft.open(one_writer()); });
}

CheckpointWriter::~CheckpointWriter() {
    Quiet const quiet;
    draft_.reset();
}

ParallelIoMode const& CheckpointWriter::way() const { return draft_->way; }

void CheckpointWriter::put(std::string const& array, std::span<ArrayPart const> parts) {
    if (draft_->failure) return;
    Quiet const quiet;
    try {
        draft_->put(array, parts);
    } catch (...) {
        if (draft_->way.collective) throw;
        draft_->failure = std::current_exception();
    }
}

void CheckpointWriter::finish() {
    Quiet const quiet;
    Draft& draft = *draft_;
    Communicator const& communicator = draft.communicator;
    if (draft.way.collective)
        draft.close();
    else
        on_first_rank(communicator, [&] {
            if (draft.failure) std::rethrow_exception(std::exchange(draft.failure, nullptr));
            draft.close();
        });
    std::uint64_t const all = sum_over(communicator, draft.of_values);
    on_first_rank(communicator, [&] {
        put_checksum(draft.name, draft.file, checksum_of(draft.head, draft.sizes, all));
    });
    draft.seal();
    draft.require_that_it_reads_back();
    on_first_rank(communicator, [&] {
        keep_previous(draft.file);
        rename_file(draft.name, draft.file);
    });
    draft.is_finished = true;
}

void write_checkpoint(std::string const& file, Checkpoint const& checkpoint) {
    std::unique_ptr<Communicator> const alone = serial_communicator();
    CheckpointWriter(*alone, file, checkpoint, {}).finish();
}

}  // namespace catena
