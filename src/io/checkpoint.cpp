// Checkpoints: attributes format, version, step, time, scene_hash and checksum at the root; groups notes (texts), integers and
// arrays (doubles), one dataset an entry. The checksum runs over all of it in the order of the keys: what was handed over is what is read.
// A seal in front of HDF5's own bytes tells of damage before HDF5 meets it.
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "error.hpp"
#include "io/checksum.hpp"
#include "io/hdf5_data.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"
#include "io/seal.hpp"

namespace catena {
namespace {

using namespace hdf5;

std::string const writing = "write the checkpoint";
std::string const reading = "read the checkpoint";
std::string const format = "catena checkpoint";
constexpr std::int64_t format_version = 2;

/// All but the arrays, which the caller adds in the order of their keys.
Checksum checksum_of_head(Checkpoint const& checkpoint) {
    Checksum sum;
    sum.add(checkpoint.step);
    sum.add(checkpoint.time);
    sum.add(std::string_view(checkpoint.scene_hash));
    for (auto const& [key, text] : checkpoint.notes) {
        sum.add(std::string_view(key));
        sum.add(std::string_view(text));
    }
    for (auto const& [key, value] : checkpoint.integers) {
        sum.add(std::string_view(key));
        sum.add(value);
    }
    return sum;
}

void add_head_of_array(Checksum& sum, std::string const& key, std::size_t size) {
    sum.add(std::string_view(key));
    sum.add(std::uint64_t{size});
}

void add_values(Checksum& sum, std::span<double const> values) {
    for (double const value : values) sum.add(value);
}

std::string previous_of(std::string const& file) {
    std::filesystem::path const path(file);
    return (path.parent_path() / (path.stem().string() + ".previous" + path.extension().string())).string();
}

void require_key(std::string const& key, std::string const& file) {
    if (key.empty() || key == "." || key.find('/') != std::string::npos)
        throw ComputationError("cannot write the checkpoint (" + file + "): '" + key + "' is no name for a dataset");
}

template <class Map, class Put>
void put_all(Place const& root, std::string const& group, Map const& entries, Put put) {
    Group const owner = make_group(root, group);
    Place const place{owner.get(), root.file, root.doing};
    for (auto const& [key, value] : entries) {
        require_key(key, root.file);
        Dataset data = put(place, key, value);
        check(data.close(), root.file, root.doing);
    }
}

void put_head(Place const& root, Checkpoint const& checkpoint) {
    put_text(root, "format", format);
    put_attribute(root, "version", format_version);
    put_attribute(root, "step", checkpoint.step);
    put_attribute(root, "time_bits", std::bit_cast<std::int64_t>(checkpoint.time));
    put_text(root, "scene_hash", checkpoint.scene_hash);
    put_all(root, "notes", checkpoint.notes, [](Place const& place, std::string const& key, std::string const& text) {
        return put_array(place, key, std::span<std::string const>(&text, 1));
    });
    put_all(root, "integers", checkpoint.integers, [](Place const& place, std::string const& key, std::int64_t value) {
        return put_array(place, key, std::span<std::int64_t const>(&value, 1));
    });
}

std::vector<std::string> keys_of(Place const& group) {
    H5G_info_t info;
    check(H5Gget_info(group.id, &info), group.file, group.doing);
    std::vector<std::string> keys;
    for (hsize_t k = 0; k < info.nlinks; ++k) {
        ssize_t const length =
            check(H5Lget_name_by_idx(group.id, ".", H5_INDEX_NAME, H5_ITER_INC, k, nullptr, 0, H5P_DEFAULT), group.file, group.doing);
        std::string key(static_cast<std::size_t>(length) + 1, '\0');
        check(H5Lget_name_by_idx(group.id, ".", H5_INDEX_NAME, H5_ITER_INC, k, key.data(), key.size(), H5P_DEFAULT), group.file,
              group.doing);
        key.pop_back();
        keys.push_back(std::move(key));
    }
    return keys;
}

/// Opens a dataset and its space; the number of elements comes with it.
struct Entry {
    Entry(Place const& group, std::string const& key) : data(check(H5Dopen2(group.id, key.c_str(), H5P_DEFAULT), group.file, group.doing)) {
        Space const space(check(H5Dget_space(data.get()), group.file, group.doing));
        if (check(H5Sget_simple_extent_ndims(space.get()), group.file, group.doing) > 1) throw ComputationError(key + " is a table");
        size = static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.get()), group.file, group.doing));
        // What claims to be larger than its file is damaged, and not worth the memory.
        if (size * sizeof(double) > std::filesystem::file_size(group.file)) throw ComputationError(key + " is larger than the file");
    }
    Dataset data;
    std::size_t size = 0;
};

std::string get_note(Place const& group, std::string const& key) {
    Entry const entry(group, key);
    Type const type(check(H5Dget_type(entry.data.get()), group.file, group.doing));
    std::size_t const length = H5Tget_size(type.get());
    if (entry.size != 1 || H5Tget_class(type.get()) != H5T_STRING || length > std::filesystem::file_size(group.file))
        throw ComputationError(key + " is no text");
    std::string text(length, '\0');
    check(H5Dread(entry.data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), group.file, group.doing);
    text.erase(text.find_last_not_of('\0') + 1);
    return text;
}

template <class Value>
std::vector<Value> get_values(Place const& group, std::string const& key, hid_t type) {
    Entry const entry(group, key);
    std::vector<Value> values(entry.size);
    if (!values.empty()) check(H5Dread(entry.data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), group.file, group.doing);
    return values;
}

std::int64_t get_integer(Place const& root, std::string const& name) {
    Attribute const attribute(check(H5Aopen(root.id, name.c_str(), H5P_DEFAULT), root.file, root.doing));
    std::int64_t value = 0;
    check(H5Aread(attribute.get(), H5T_NATIVE_INT64, &value), root.file, root.doing);
    return value;
}

Group open_group(Place const& root, char const* name) { return Group(check(H5Gopen2(root.id, name, H5P_DEFAULT), root.file, root.doing)); }

enum class Arrays { keep, only_check };

/// Piece by piece through the checksum; without values where they are only checked.
std::vector<double> read_array(Place const& group, std::string const& key, Checksum& sum, Arrays wish) {
    constexpr hsize_t most = 1 << 18;
    Entry const entry(group, key);
    std::vector<double> values(wish == Arrays::keep ? entry.size : 0), piece(std::min<std::size_t>(most, entry.size));
    add_head_of_array(sum, key, entry.size);
    Space const in_file(check(H5Dget_space(entry.data.get()), group.file, group.doing));
    for (hsize_t at = 0; at < entry.size; at += most) {
        hsize_t const count = std::min<hsize_t>(most, entry.size - at);
        Space const in_memory(check(H5Screate_simple(1, &count, nullptr), group.file, group.doing));
        check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, &at, nullptr, &count, nullptr), group.file, group.doing);
        check(H5Dread(entry.data.get(), H5T_NATIVE_DOUBLE, in_memory.get(), in_file.get(), H5P_DEFAULT, piece.data()), group.file,
              group.doing);
        add_values(sum, std::span(piece).first(count));
        if (wish == Arrays::keep) std::copy_n(piece.begin(), count, values.begin() + static_cast<std::ptrdiff_t>(at));
    }
    return values;
}

/// Throws ComputationError where the file is damaged. Checked only, it takes the memory of a piece of an array.
Checkpoint read_verified(Place const& root, Arrays wish) {
    Checkpoint checkpoint;
    checkpoint.step = get_integer(root, "step");
    checkpoint.time = std::bit_cast<double>(get_integer(root, "time_bits"));
    checkpoint.scene_hash = get_text(root, "scene_hash");
    Group const notes = open_group(root, "notes"), integers = open_group(root, "integers"), arrays = open_group(root, "arrays");
    Place const in_notes{notes.get(), root.file, root.doing}, in_integers{integers.get(), root.file, root.doing},
        in_arrays{arrays.get(), root.file, root.doing};
    for (std::string const& key : keys_of(in_notes)) checkpoint.notes[key] = get_note(in_notes, key);
    for (std::string const& key : keys_of(in_integers)) {
        auto const values = get_values<std::int64_t>(in_integers, key, H5T_NATIVE_INT64);
        if (values.size() != 1) throw ComputationError(key + " is not one number");
        checkpoint.integers[key] = values[0];
    }
    Checksum sum = checksum_of_head(checkpoint);
    for (std::string const& key : keys_of(in_arrays)) {
        std::vector<double> values = read_array(in_arrays, key, sum, wish);
        if (wish == Arrays::keep) checkpoint.arrays[key] = std::move(values);
    }
    if (std::bit_cast<std::uint64_t>(get_integer(root, "checksum")) != sum.value())
        throw ComputationError("its checksum does not fit its contents");
    return checkpoint;
}

bool is_plain_hdf5(std::string const& file) {
    std::string start(8, '\0');
    std::ifstream(file, std::ios::binary).read(start.data(), std::ssize(start));
    return start == "\x89HDF\r\n\x1a\n";
}

/// Throws InputError for what HDF5 had better not see.
void require_seal(std::string const& file, bool has_previous, std::string const& remedy) {
    std::string const name_one = "name the checkpoint.h5 of a run";
    try {
        if (has_seal(file)) {
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

Checkpoint read_sealed(std::string const& file, Arrays wish, std::string const& remedy) {
    File const handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!handle) throw InputError("not a checkpoint, " + cause(), file, remedy);
    Place const root{handle.get(), file, reading};
    try {
        if (get_text(root, "format") != format) throw ComputationError("it tells of no checkpoint");
        if (get_integer(root, "version") != format_version)
            throw InputError("a checkpoint of another version of Catena", file, "restart with the version that wrote it");
        return read_verified(root, wish);
    } catch (InputError const&) {
        throw;
    } catch (std::exception const& error) {
        throw InputError("the checkpoint is damaged, " + std::string(error.what()), file, remedy);
    }
}

/// The file of this name stays; `previous` becomes another name of it, so that no moment is without a checkpoint.
void keep_previous(std::string const& file) {
    if (!std::filesystem::exists(file)) return;
    std::string const spare = previous_of(file) + ".writing";
    ::unlink(spare.c_str());
    if (::link(file.c_str(), spare.c_str()) == 0) return rename_file(spare, previous_of(file));
    rename_file(file, previous_of(file));  // a file system without hard links
}

}  // namespace

/// `name` is written; messages name `file`.
struct CheckpointWriter::Draft {
    Draft(std::string of, Checkpoint const& checkpoint)
        : file(std::move(of)), name(file + ".writing"), handle(create(name, file)), sum(checksum_of_head(checkpoint)) {
        put_head(root(), checkpoint);
        arrays = make_group(root(), "arrays");
    }
    Place root() const { return {handle.get(), file, writing}; }
    static hid_t create(std::string const& name, std::string const& file) {
        Properties const properties(check(H5Pcreate(H5P_FILE_CREATE), file, writing));
        check(H5Pset_userblock(properties.get(), seal_size), file, writing);
        return check(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, properties.get(), H5P_DEFAULT), file, writing);
    }

    std::string file, name;
    File handle;
    Group arrays;
    Dataset array;  // being written
    hsize_t size = 0, written = 0;
    Checksum sum;
};

CheckpointWriter::CheckpointWriter(std::string const& file, Checkpoint const& checkpoint) {
    Quiet const quiet;
    try {
        draft_ = std::make_unique<Draft>(file, checkpoint);
    } catch (...) {
        ::unlink((file + ".writing").c_str());
        throw;
    }
}

CheckpointWriter::~CheckpointWriter() {
    if (!draft_) return;
    Quiet const quiet;
    ::unlink(draft_->name.c_str());
    draft_.reset();
}

void CheckpointWriter::begin_array(std::string const& name, std::int64_t size) {
    Quiet const quiet;
    require_key(name, draft_->file);
    Place const place{draft_->arrays.get(), draft_->file, writing};
    if (draft_->array) check(draft_->array.close(), draft_->file, writing);
    draft_->size = static_cast<hsize_t>(size);
    draft_->written = 0;
    Space const space(check(H5Screate_simple(1, &draft_->size, nullptr), draft_->file, writing));
    draft_->array = Dataset(check(H5Dcreate2(place.id, name.c_str(), H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                  draft_->file, writing));
    add_head_of_array(draft_->sum, name, draft_->size);
}

void CheckpointWriter::put(std::span<double const> values) {
    if (values.empty()) return;
    Quiet const quiet;
    hsize_t const count = values.size();
    Space const in_file(check(H5Dget_space(draft_->array.get()), draft_->file, writing)),
        in_memory(check(H5Screate_simple(1, &count, nullptr), draft_->file, writing));
    check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, &draft_->written, nullptr, &count, nullptr), draft_->file, writing);
    check(H5Dwrite(draft_->array.get(), H5T_NATIVE_DOUBLE, in_memory.get(), in_file.get(), H5P_DEFAULT, values.data()), draft_->file,
          writing);
    add_values(draft_->sum, values);
    draft_->written += count;
}

void CheckpointWriter::finish() {
    Quiet const quiet;
    std::string const file = draft_->file, name = draft_->name;
    try {
        put_attribute(draft_->root(), "checksum", std::bit_cast<std::int64_t>(draft_->sum.value()));
        if (draft_->array) check(draft_->array.close(), file, writing);
        check(draft_->arrays.close(), file, writing);
        flush_to_disk(draft_->handle, file, writing);
        check(draft_->handle.close(), file, writing);
        put_seal(name, file, writing);
        read_sealed(name, Arrays::only_check, "");
        keep_previous(file);
        rename_file(name, file);
        draft_.reset();
    } catch (InputError const& error) {
        throw ComputationError("cannot write the checkpoint (" + file + "): it does not read back, " + error.what());
    }
}

void write_checkpoint(std::string const& file, Checkpoint const& checkpoint) {
    CheckpointWriter writer(file, checkpoint);
    for (auto const& [name, values] : checkpoint.arrays) {
        writer.begin_array(name, std::ssize(values));
        writer.put(values);
    }
    writer.finish();
}

Checkpoint read_checkpoint(std::string const& file) {
    Quiet const quiet;
    if (!std::filesystem::exists(file)) throw InputError("no such checkpoint", file, "name the checkpoint.h5 of a run");
    std::string const previous = previous_of(file);
    bool const has_previous = std::filesystem::exists(previous);
    std::string const remedy = has_previous ? "use the one before, " + previous : "start anew";
    require_seal(file, has_previous, remedy);
    return read_sealed(file, Arrays::keep, remedy);
}

}  // namespace catena
