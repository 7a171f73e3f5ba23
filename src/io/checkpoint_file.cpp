// Implements creation, checksums and reading of checkpoint files.
#include "io/checkpoint_file.hpp"

#include <algorithm>
#include <bit>

#include "error.hpp"
#include "io/checksum.hpp"
#include "io/file_seal.hpp"

namespace catena::hdf5 {
namespace {

std::string const format = "catena checkpoint";
constexpr std::int64_t format_version = 3;

/// Throws ComputationError if `key` cannot name a dataset.
void require_key(std::string const& key, std::string const& file) {
    if (key.empty() || key == "." || key.find('/') != std::string::npos)
        throw ComputationError("cannot write the checkpoint (" + file + "): '" + key +
                               "' is not a name for a dataset");
}

/// Writes the entries of a map as datasets of a new group, by the function `put`.
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

/// Creates a dataset without contents. Its space in the file is allocated at once, so that any rank
/// may write into it.
Dataset put_room(Place const& place, std::string const& key, std::int64_t size) {
    auto const count = static_cast<hsize_t>(size);
    Space const space(check(H5Screate_simple(1, &count, nullptr), place.file, place.doing));
    Properties const creation(check(H5Pcreate(H5P_DATASET_CREATE), place.file, place.doing));
    check(H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY), place.file, place.doing);
    check(H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER), place.file, place.doing);
    return Dataset(check(H5Dcreate2(place.id, key.c_str(), H5T_NATIVE_DOUBLE, space.get(),
                                    H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                         place.file + ", " + key, place.doing));
}

/// Names of all datasets in a group, in ascending order.
std::vector<std::string> keys_of(Place const& group) {
    H5G_info_t info;
    check(H5Gget_info(group.id, &info), group.file, group.doing);
    std::vector<std::string> keys;
    for (hsize_t k = 0; k < info.nlinks; ++k) {
        ssize_t const length = check(H5Lget_name_by_idx(group.id, ".", H5_INDEX_NAME, H5_ITER_INC,
                                                        k, nullptr, 0, H5P_DEFAULT),
                                     group.file, group.doing);
        std::string key(static_cast<std::size_t>(length) + 1, '\0');
        check(H5Lget_name_by_idx(group.id, ".", H5_INDEX_NAME, H5_ITER_INC, k, key.data(),
                                 key.size(), H5P_DEFAULT),
              group.file, group.doing);
        key.pop_back();
        keys.push_back(std::move(key));
    }
    return keys;
}

/// Size of the file that contains the group, whatever its name is by now.
std::size_t bytes_of_file(Place const& group) {
    File const file(check(H5Iget_file_id(group.id), group.file, group.doing));
    hsize_t bytes = 0;
    check(H5Fget_filesize(file.get(), &bytes), group.file, group.doing);
    return bytes;
}

/// Opened dataset and its number of elements. Throws ComputationError for arrays of more
/// dimensions.
struct Entry {
    Entry(Place const& group, std::string const& key)
        : data(check(H5Dopen2(group.id, key.c_str(), H5P_DEFAULT), group.file, group.doing)) {
        Space const space(check(H5Dget_space(data.get()), group.file, group.doing));
        if (check(H5Sget_simple_extent_ndims(space.get()), group.file, group.doing) > 1)
            throw ComputationError(key + " is a table");
        size = static_cast<std::size_t>(
            check(H5Sget_simple_extent_npoints(space.get()), group.file, group.doing));
        // An array that claims to be larger than its file is damaged, and no memory is allocated
        // for it.
        if (size > bytes_of_file(group) / sizeof(double))
            throw ComputationError(key + " is larger than the file");
    }
    Dataset data;
    std::size_t size = 0;
};

/// Reads a dataset that must be a single text of fixed length.
std::string get_note(Place const& group, std::string const& key) {
    Entry const entry(group, key);
    Type const type(check(H5Dget_type(entry.data.get()), group.file, group.doing));
    std::size_t const length = H5Tget_size(type.get());
    if (entry.size != 1 || H5Tget_class(type.get()) != H5T_STRING ||
        H5Tis_variable_str(type.get()) > 0 || length > bytes_of_file(group))
        throw ComputationError(key + " is not a text");
    std::string text(length, '\0');
    check(H5Dread(entry.data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()),
          group.file, group.doing);
    text.erase(text.find_last_not_of('\0') + 1);
    return text;
}

/// Reads a dataset that must be a single integer.
std::int64_t get_value(Place const& group, std::string const& key) {
    Entry const entry(group, key);
    if (entry.size != 1) throw ComputationError(key + " is not one number");
    std::int64_t value = 0;
    check(H5Dread(entry.data.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value),
          group.file, group.doing);
    return value;
}

std::int64_t get_integer(Place const& root, std::string const& name) {
    Attribute const attribute(
        check(H5Aopen(root.id, name.c_str(), H5P_DEFAULT), root.file, root.doing));
    std::int64_t value = 0;
    check(H5Aread(attribute.get(), H5T_NATIVE_INT64, &value), root.file, root.doing);
    return value;
}

/// Returns a string attribute of fixed length. Variable length is refused: HDF5 reads beyond its
/// buffers on damaged texts of that kind.
std::string get_fixed_text(Place const& root, std::string const& name) {
    Attribute const attribute(
        check(H5Aopen(root.id, name.c_str(), H5P_DEFAULT), root.file, root.doing));
    Type const type(check(H5Aget_type(attribute.get()), root.file, root.doing));
    if (H5Tis_variable_str(type.get()) > 0) throw ComputationError(name + " is not a text");
    return get_text(root, name);
}

Group open_group(Place const& root, char const* name) {
    return Group(check(H5Gopen2(root.id, name, H5P_DEFAULT), root.file, root.doing));
}

/// Adds the reader's share of an array to the checksum, piece by piece, and copies it to `kept`
/// unless that is null.
void read_array(Place const& group, std::string const& key, Reader const& reader,
                CheckpointRead& read, std::vector<double>* kept) {
    constexpr std::int64_t most = 1 << 18;  // elements of a piece
    Entry const entry(group, key);
    auto const size = static_cast<std::int64_t>(entry.size);
    read.sizes[key] = size;
    std::int64_t const begin = size * reader.number / reader.of,
                       end = size * (reader.number + 1) / reader.of;
    std::vector<double> piece(static_cast<std::size_t>(std::min(most, end - begin)));
    if (kept) kept->resize(static_cast<std::size_t>(end - begin));
    Space const in_file(check(H5Dget_space(entry.data.get()), group.file, group.doing));
    for (std::int64_t at = begin; at < end; at += most) {
        auto const first = static_cast<hsize_t>(at),
                   count = static_cast<hsize_t>(std::min(most, end - at));
        Space const in_memory(check(H5Screate_simple(1, &count, nullptr), group.file, group.doing));
        check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, &first, nullptr, &count, nullptr),
              group.file, group.doing);
        check(H5Dread(entry.data.get(), H5T_NATIVE_DOUBLE, in_memory.get(), in_file.get(),
                      H5P_DEFAULT, piece.data()),
              group.file, group.doing);
        read.of_values += checksum_of_values(key, at, std::span(piece).first(count));
        if (kept) std::copy_n(piece.begin(), count, kept->begin() + (at - begin));
    }
}

}  // namespace

std::uint64_t checksum_of_values(std::string const& array, std::int64_t first,
                                 std::span<double const> values) {
    Checksum name;
    name.add(std::string_view(array));
    std::uint64_t place = name.value() + static_cast<std::uint64_t>(first), sum = 0;
    for (double const value : values)
        sum += checksum_at(place++, std::bit_cast<std::uint64_t>(value));
    return sum;
}

std::uint64_t checksum_of(Checkpoint const& head, ArraySizes const& sizes,
                          std::uint64_t of_values) {
    Checksum sum;
    sum.add(head.step);
    sum.add(head.time);
    sum.add(std::string_view(head.scene_hash));
    for (auto const& [key, text] : head.notes) {
        sum.add(std::string_view(key));
        sum.add(std::string_view(text));
    }
    for (auto const& [key, value] : head.integers) {
        sum.add(std::string_view(key));
        sum.add(value);
    }
    for (auto const& [key, size] : sizes) {
        sum.add(std::string_view(key));
        sum.add(size);
    }
    sum.add(of_values);
    return sum.value();
}

void make_checkpoint_file(std::string const& name, std::string const& file,
                          Checkpoint const& checkpoint, ArraySizes const& later) {
    std::string const& writing = writing_checkpoint;
    Properties const creation(check(H5Pcreate(H5P_FILE_CREATE), file, writing));
    check(H5Pset_userblock(creation.get(), seal_size), file, writing);
    File handle(check(create_anew(name, creation.get(), H5P_DEFAULT), file, writing));
    Place const root{handle.get(), file, writing};
    put_text(root, "format", format);
    put_attribute(root, "version", format_version);
    put_attribute(root, "step", checkpoint.step);
    put_attribute(root, "time_bits", std::bit_cast<std::int64_t>(checkpoint.time));
    put_text(root, "scene_hash", checkpoint.scene_hash);
    put_attribute(root, "checksum", 0);
    put_all(root, "notes", checkpoint.notes,
            [](Place const& place, std::string const& key, std::string const& text) {
                return put_array(place, key, std::span<std::string const>(&text, 1));
            });
    put_all(root, "integers", checkpoint.integers,
            [](Place const& place, std::string const& key, std::int64_t value) {
                return put_array(place, key, std::span<std::int64_t const>(&value, 1));
            });
    put_all(root, "arrays", checkpoint.arrays,
            [](Place const& place, std::string const& key, std::vector<double> const& values) {
                return put_array(place, key, std::span<double const>(values));
            });
    Group const arrays = open_group(root, "arrays");
    for (auto const& [key, size] : later) {
        require_key(key, file);
        Dataset room = put_room({arrays.get(), file, writing}, key, size);
        check(room.close(), file, writing);
    }
    take_room(handle, file, writing);
    check(H5Fflush(handle.get(), H5F_SCOPE_LOCAL), file,
          writing);  // H5Fclose reports success whatever happens
    check(handle.close(), file, writing);
}

Dataset open_array(Place const& root, std::string const& name) {
    return Dataset(
        check(H5Dopen2(root.id, ("arrays/" + name).c_str(), H5P_DEFAULT), root.file, root.doing));
}

void put_checksum(std::string const& name, std::string const& file, std::uint64_t checksum) {
    std::string const& writing = writing_checkpoint;
    File handle(check(H5Fopen(name.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), file, writing));
    Attribute attribute(check(H5Aopen(handle.get(), "checksum", H5P_DEFAULT), file, writing));
    auto const value = std::bit_cast<std::int64_t>(checksum);
    check(H5Awrite(attribute.get(), H5T_NATIVE_INT64, &value), file, writing);
    check(attribute.close(), file, writing);
    flush_to_disk(handle, file, writing);
    check(handle.close(), file, writing);
}

CheckpointRead read_checkpoint_file(Place const& root, Arrays wish, Reader reader) {
    if (get_fixed_text(root, "format") != format)
        throw ComputationError("it does not describe a checkpoint");
    if (get_integer(root, "version") != format_version)
        throw InputError("a checkpoint of another version of Catena", root.file,
                         "restart with the version that wrote it");
    CheckpointRead read;
    Checkpoint& contents = read.contents;
    contents.step = get_integer(root, "step");
    if (contents.step < 0) throw ComputationError("its step is " + std::to_string(contents.step));
    contents.time = std::bit_cast<double>(get_integer(root, "time_bits"));
    contents.scene_hash = get_fixed_text(root, "scene_hash");
    read.checksum = std::bit_cast<std::uint64_t>(get_integer(root, "checksum"));
    Group const notes = open_group(root, "notes"), integers = open_group(root, "integers"),
                arrays = open_group(root, "arrays");
    Place const in_notes{notes.get(), root.file, root.doing},
        in_integers{integers.get(), root.file, root.doing},
        in_arrays{arrays.get(), root.file, root.doing};
    for (std::string const& key : keys_of(in_notes)) contents.notes[key] = get_note(in_notes, key);
    for (std::string const& key : keys_of(in_integers))
        contents.integers[key] = get_value(in_integers, key);
    for (std::string const& key : keys_of(in_arrays))
        read_array(in_arrays, key, reader, read,
                   wish == Arrays::keep ? &contents.arrays[key] : nullptr);
    return read;
}

}  // namespace catena::hdf5
