// Reader of checkpoints, which uses a file only if its seal and its checksums hold. Layout of the
// file: checkpoint_file.hpp.
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

#include "error.hpp"
#include "io/checkpoint_file.hpp"
#include "io/descriptor.hpp"
#include "io/file_seal.hpp"

namespace catena {
namespace {

using namespace hdf5;

/// Checkpoint file as it is at the time of opening: a run that writes replaces the file of that
/// name.
class OpenedCheckpoint {
  public:
    explicit OpenedCheckpoint(std::string const& file)
        : file_(file), descriptor_(file, O_RDONLY | O_NONBLOCK, file, reading_checkpoint) {}
    /// Returns a path to the opened file, whatever has its name by now. Systems without /proc use
    /// the name.
    std::string path() const {
        std::string const opened = "/proc/self/fd/" + std::to_string(descriptor_.get());
        return ::access(opened.c_str(), R_OK) == 0 ? opened : file_;
    }

  private:
    std::string file_;
    Descriptor descriptor_;
};

/// Opens a checkpoint. Throws InputError with `remedy` if that fails.
std::unique_ptr<OpenedCheckpoint const> open_checkpoint(std::string const& file,
                                                        std::string const& remedy) {
    try {
        return std::make_unique<OpenedCheckpoint const>(file);
    } catch (ComputationError const& error) {
        throw InputError("the checkpoint cannot be read, " + std::string(error.what()), file,
                         remedy);
    }
}

/// True if the file starts with HDF5's signature and therefore has no seal.
bool is_plain_hdf5(std::string const& file) {
    if (!std::filesystem::is_regular_file(file)) return false;
    std::string start(8, '\0');
    std::ifstream(file, std::ios::binary).read(start.data(), std::ssize(start));
    return start == "\x89HDF\r\n\x1a\n";
}

/// Throws InputError for a file that HDF5 must not parse, i.e. one without a valid seal. `path`:
/// the opened file; messages name `file`.
void require_seal(std::string const& path, std::string const& file, bool has_previous,
                  std::string const& remedy) {
    std::string const name_one = "name the checkpoint.h5 of a run";
    try {
        SealKind const kind = kind_of_seal(path);
        if (kind == SealKind::earlier)
            throw InputError("a checkpoint of another version of Catena", file,
                             "restart with the version that wrote it");
        if (kind == SealKind::own) {
            if (std::string const wrong = broken_seal(path); !wrong.empty())
                throw InputError("the checkpoint is damaged, " + wrong, file, remedy);
            return;
        }
        if (is_plain_hdf5(path))
            throw InputError("not a checkpoint of Catena, or one of an earlier version", file,
                             "restart with the version that wrote it, or " + name_one);
    } catch (InputError const&) {
        throw;
    } catch (std::exception const& error) {
        throw InputError("the checkpoint cannot be read, " + std::string(error.what()), file,
                         remedy);
    }
    throw InputError("not a checkpoint of Catena, or damaged", file,
                     has_previous ? remedy : name_one);
}

/// Returns what to do where there is no checkpoint. A killed run may have left its tables alone.
std::string remedy_of_missing(std::string const& file) {
    std::filesystem::path const folder = std::filesystem::path(file).parent_path();
    std::error_code unseen;
    if (!std::filesystem::exists(folder / "observables.csv", unseen))
        return "name the checkpoint.h5 of a run";
    return "name the checkpoint.h5 of a run; if this run ended before its first one, start it "
           "anew with --overwrite and a smaller output.checkpoint_every";
}

/// Throws InputError for a folder, with the checkpoint that it holds.
void refuse_folder(std::string const& file) {
    if (!std::filesystem::is_directory(file)) return;
    for (char const* const name : {"checkpoint.h5", "checkpoint.previous.h5"}) {
        std::filesystem::path const inside = std::filesystem::path(file) / name;
        std::error_code unseen;
        if (std::filesystem::is_regular_file(inside, unseen))
            throw InputError("a folder, not a checkpoint", file, "name " + inside.string());
    }
    throw InputError("a folder, not a checkpoint", file,
                     remedy_of_missing((std::filesystem::path(file) / "checkpoint.h5").string()));
}

}  // namespace

std::string previous_checkpoint(std::string const& file) {
    std::filesystem::path const path(file);
    return (path.parent_path() / (path.stem().string() + ".previous" + path.extension().string()))
        .string();
}

Checkpoint read_checkpoint(std::string const& file) {
    Quiet const quiet;
    std::error_code unseen;
    bool const exists = std::filesystem::exists(file, unseen);
    if (unseen)
        throw InputError("the checkpoint cannot be accessed, " + unseen.message(), file,
                         "name the checkpoint.h5 of a run");
    if (!exists) throw InputError("no such checkpoint", file, remedy_of_missing(file));
    refuse_folder(file);
    std::string const previous = previous_checkpoint(file);
    bool const has_previous = std::filesystem::exists(previous, unseen);
    std::string const remedy = has_previous ? "use the previous one, " + previous : "start anew";
    std::unique_ptr<OpenedCheckpoint const> const opened_file = open_checkpoint(file, remedy);
    OpenedCheckpoint const& opened = *opened_file;
    try {
        require_seal(opened.path(), file, has_previous, remedy);
        File const handle(H5Fopen(opened.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
        if (!handle) throw InputError("not a checkpoint, " + cause(), file, remedy);
        CheckpointRead read =
            read_checkpoint_file({handle.get(), file, reading_checkpoint}, Arrays::keep, {});
        if (read.checksum != checksum_of(read.contents, read.sizes, read.of_values))
            throw ComputationError("its checksum does not match its contents");
        return std::move(read.contents);
    } catch (InputError const&) {
        throw;
    } catch (std::bad_alloc const&) {
        throw;
    } catch (std::exception const& error) {
        throw InputError("the checkpoint is damaged, " + std::string(error.what()), file, remedy);
    }
}

}  // namespace catena
