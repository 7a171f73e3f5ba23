// Reads a checkpoint, as far as its seal and its checksums hold; what lies where in the file: checkpoint_file.hpp.
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "error.hpp"
#include "io/checkpoint_file.hpp"
#include "io/seal.hpp"

namespace catena {
namespace {

using namespace hdf5;

bool is_plain_hdf5(std::string const& file) {
    std::string start(8, '\0');
    std::ifstream(file, std::ios::binary).read(start.data(), std::ssize(start));
    return start == "\x89HDF\r\n\x1a\n";
}

/// Throws InputError for what HDF5 had better not see.
void require_seal(std::string const& file, bool has_previous, std::string const& remedy) {
    std::string const name_one = "name the checkpoint.h5 of a run";
    try {
        SealKind const kind = kind_of_seal(file);
        if (kind == SealKind::earlier)
            throw InputError("a checkpoint of another version of Catena", file, "restart with the version that wrote it");
        if (kind == SealKind::own) {
            if (std::string const wrong = broken_seal(file); !wrong.empty())
                throw InputError("the checkpoint is damaged, " + wrong, file, remedy);
            return;
        }
        if (is_plain_hdf5(file))
            throw InputError("not a checkpoint of Catena, or one of an earlier version", file,
                             "restart with the version that wrote it, or " + name_one);
    } catch (InputError const&) {
        throw;
    } catch (std::exception const& error) {
        throw InputError("the checkpoint cannot be read, " + std::string(error.what()), file, remedy);
    }
    throw InputError("not a checkpoint of Catena, or damaged", file, has_previous ? remedy : name_one);
}

}  // namespace

std::string previous_checkpoint(std::string const& file) {
    std::filesystem::path const path(file);
    return (path.parent_path() / (path.stem().string() + ".previous" + path.extension().string())).string();
}

Checkpoint read_checkpoint(std::string const& file) {
    Quiet const quiet;
    std::error_code unseen;
    bool const exists = std::filesystem::exists(file, unseen);
    if (unseen) throw InputError("the checkpoint cannot be looked at, " + unseen.message(), file, "name the checkpoint.h5 of a run");
    if (!exists) throw InputError("no such checkpoint", file, "name the checkpoint.h5 of a run");
    std::string const previous = previous_checkpoint(file);
    bool const has_previous = std::filesystem::exists(previous, unseen);
    std::string const remedy = has_previous ? "use the one before, " + previous : "start anew";
    require_seal(file, has_previous, remedy);
    File const handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!handle) throw InputError("not a checkpoint, " + cause(), file, remedy);
    try {
        CheckpointRead read = read_checkpoint_file({handle.get(), file, reading_checkpoint}, Arrays::keep, {});
        if (read.checksum != checksum_of(read.contents, read.sizes, read.of_values))
            throw ComputationError("its checksum does not fit its contents");
        return std::move(read.contents);
    } catch (InputError const&) {
        throw;
    } catch (std::exception const& error) {
        throw InputError("the checkpoint is damaged, " + std::string(error.what()), file, remedy);
    }
}

}  // namespace catena
