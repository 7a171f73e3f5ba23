// Implements the checked, block by block reading of HDF5 datasets.
#include "bodies/hdf5_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "bodies/hdf5_texts.hpp"
#include "error.hpp"
#include "io/memory_limit.hpp"
#include "scene/node.hpp"

namespace catena::scene {

namespace {

/// Largest ratio of compression to believe: deflate compresses at most 1032 bytes into one.
double constexpr best_compression = 1100;
/// Memory of a body in the arrays, bytes, rounded up.
double constexpr bytes_a_body = 256;
hsize_t constexpr largest_chunk = hsize_t{1} << 30;  // bytes
/// Number of rows per block, and longest text of fixed length in bytes.
std::size_t constexpr rows_a_block = 1 << 16, longest_text = 1024;

/// Half-precision type as h5py writes it; HDF5 1.10 has no name for it.
hdf5::Type half(H5T_order_t order) {
    hdf5::Type type(H5Tcopy(H5T_IEEE_F32LE));
    H5Tset_fields(type.get(), 15, 10, 5, 0, 10);
    H5Tset_size(type.get(), 2);
    H5Tset_ebias(type.get(), 15);
    H5Tset_order(type.get(), order);
    return type;
}

/// True for the number types of common machines. HDF5 overruns its buffers when it converts other
/// types, such as integers of zero bits.
bool is_number(hdf5::Type const& type) {
    hid_t const known[] = {H5T_IEEE_F64LE,     H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_IEEE_F32BE,
                           H5T_NATIVE_LDOUBLE, H5T_STD_I64LE,  H5T_STD_I64BE,  H5T_STD_U64LE,
                           H5T_STD_U64BE,      H5T_STD_I32LE,  H5T_STD_I32BE,  H5T_STD_U32LE,
                           H5T_STD_U32BE,      H5T_STD_I16LE,  H5T_STD_I16BE,  H5T_STD_U16LE,
                           H5T_STD_U16BE,      H5T_STD_I8LE,   H5T_STD_I8BE,   H5T_STD_U8LE,
                           H5T_STD_U8BE};
    auto const is = [&](hid_t other) { return H5Tequal(type.get(), other) > 0; };
    return std::any_of(std::begin(known), std::end(known), is) || is(half(H5T_ORDER_LE).get()) ||
           is(half(H5T_ORDER_BE).get());
}

/// Shape for messages: "[10, 3]".
std::string shape_text(std::vector<hsize_t> const& shape) {
    return fmt::format("[{}]", fmt::join(shape, ", "));
}

}  // namespace

template <class Status>
Status Hdf5Table::sound(Status status, std::string const& name) const {
    if (status < 0)
        refuse(name, whole, "the dataset cannot be read: " + shown(hdf5::cause()),
               "check the file");
    return status;
}

Hdf5Table::Hdf5Table(std::string const& path, std::string const& counted) : path_(path) {
    file_ = hdf5::File(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!file_)
        throw InputError("the file does not exist or is not an HDF5 file: " + shown(hdf5::cause()),
                         shown_path(path), "check the path");
    if (!has(counted))
        refuse(counted, whole, "the dataset is missing", "add it: its rows are the bodies");
    std::vector<hsize_t> const shape = shape_of(open(counted), counted);
    if (shape.empty() || shape[0] == 0)
        refuse(counted, whole, "the dataset is empty", "give at least one body");
    rows_ = shape[0];
    refuse_too_large(counted);
}

/// Refuses row counts that the file cannot hold or the memory cannot take. A small damaged file may
/// claim any number of rows.
void Hdf5Table::refuse_too_large(std::string const& name) const {
    hdf5::Dataset const data = open(name);
    hdf5::Type const type(sound(H5Dget_type(data.get()), name));
    double const rows = static_cast<double>(rows_),
                 claimed = rows * static_cast<double>(H5Tget_size(type.get()));
    if (claimed > best_compression * static_cast<double>(H5Dget_storage_size(data.get())))
        refuse(
            name, whole,
            fmt::format("the dataset has {} rows, but the file does not contain them all", rows_),
            "write the whole dataset");
    // The check precedes all allocations, which could end the process.
    auto const present = static_cast<double>(memory_limit());
    if (rows * bytes_a_body > present)
        refuse(name, whole,
               fmt::format("{} bodies need about {:.3g} GB of memory, and only {}", rows_,
                           rows * bytes_a_body * 1e-9, available_memory()),
               "make fewer bodies, or use a larger machine");
}

bool Hdf5Table::has(std::string const& name) const {
    return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5Table::names() const {
    std::vector<std::string> names;
    H5G_info_t info{};
    sound(H5Gget_info(file_.get(), &info), "/");
    for (hsize_t i = 0; i < info.nlinks; ++i) {
        char name[256] = {};
        sound(H5Lget_name_by_idx(file_.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name,
                                 H5P_DEFAULT),
              "/");
        names.emplace_back(name);
    }
    return names;
}

std::size_t Hdf5Table::for_each(std::string const& name, std::vector<Shape> const& shapes,
                                Read const& read) const {
    hdf5::Dataset const data = open(name);
    std::vector<hsize_t> const shape = shape_of(data, name);
    Shape const row(shape.begin() + (shape.empty() ? 0 : 1), shape.end());
    if (shape.empty() || shape[0] != rows_ ||
        std::find(shapes.begin(), shapes.end(), row) == shapes.end()) {
        std::string wanted;
        for (Shape one : shapes) {
            one.insert(one.begin(), rows_);
            wanted += (wanted.empty() ? "" : " or ") + shape_text(one);
        }
        refuse(name, whole,
               fmt::format("the dataset has shape {}, not {}", shape_text(shape), wanted),
               "give one row per body");
    }
    refuse_unless_numbers(data, name);
    std::size_t width = 1;
    for (hsize_t const extent : row) width *= extent;
    // One block serves all rows, so that no dataset is held twice.
    std::vector<double> block(std::min(rows_, rows_a_block) * width);
    for (std::size_t first = 0; first < rows_; first += rows_a_block) {
        std::size_t const count = std::min(rows_a_block, rows_ - first);
        read_block(data, name, shape, first, count, H5T_NATIVE_DOUBLE, block.data());
        for (std::size_t i = 0; i < count; ++i) {
            double const* const values = block.data() + i * width;
            for (std::size_t j = 0; j < width; ++j)
                if (!std::isfinite(values[j]))
                    refuse(name, first + i, fmt::format("{} is not finite", values[j]),
                           "give finite numbers");
            read(first + i, values, width);
        }
    }
    return width;
}

bool Hdf5Table::is_text(std::string const& name) const {
    hdf5::Dataset const data = open(name);
    hdf5::Type const type(sound(H5Dget_type(data.get()), name));
    return H5Tget_class(type.get()) == H5T_STRING;
}

void Hdf5Table::for_each_text(std::string const& name, ReadText const& read) const {
    hdf5::Dataset const data = open(name);
    std::vector<hsize_t> const shape = shape_of(data, name);
    if (shape != std::vector<hsize_t>{rows_})
        refuse(name, whole,
               fmt::format("the dataset has shape {}, not [{}]", shape_text(shape), rows_),
               "give one text per body");
    hdf5::Type const type(sound(H5Dget_type(data.get()), name));
    if (H5Tis_variable_str(type.get()) > 0) return for_each_variable_text(data, name, read);
    std::size_t const length = H5Tget_size(type.get());
    if (length == 0 || length > longest_text)
        refuse(name, whole, fmt::format("the dataset contains texts of {} bytes", length),
               fmt::format("give {} or fewer", longest_text));
    refuse_large_chunks(data, name);
    std::vector<char> block(std::min(rows_, rows_a_block) * length);
    for (std::size_t first = 0; first < rows_; first += rows_a_block) {
        std::size_t const count = std::min(rows_a_block, rows_ - first);
        read_block(data, name, shape, first, count, type.get(), block.data());
        for (std::size_t i = 0; i < count; ++i) {
            char const* const text = block.data() + i * length;
            read(first + i, std::string(text, strnlen(text, length)));
        }
    }
}

void Hdf5Table::for_each_variable_text(hdf5::Dataset const& data, std::string const& name,
                                       ReadText const& read) const {
    std::optional<VariableTexts> texts;
    for (std::size_t k = 0; k < rows_; ++k) {
        std::string text;
        try {
            if (!texts) texts.emplace(file_, data, rows_);
            text = texts->at(k);
        } catch (std::runtime_error const& error) {
            refuse(name, k == 0 && !texts ? whole : k, error.what(),
                   "check the file, or store numbers or texts of fixed length");
        }
        read(k, text);
    }
}

bool Hdf5Table::vector(std::string const& name, double (&values)[3]) const {
    if (!has(name)) return false;
    hdf5::Dataset const data = open(name);
    std::vector<hsize_t> const shape = shape_of(data, name);
    if (shape != std::vector<hsize_t>{3})
        refuse(name, whole, fmt::format("the dataset has shape {}, not [3]", shape_text(shape)),
               "give three numbers");
    refuse_unless_numbers(data, name);
    sound(H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
    for (double const value : values)
        if (!std::isfinite(value))
            refuse(name, whole, fmt::format("{} is not finite", value), "give finite numbers");
    return true;
}

void Hdf5Table::refuse(std::string const& name, std::size_t k, std::string const& what,
                       std::string const& remedy) const {
    std::string const body = k == whole ? "" : fmt::format(", body {}", k + 1);
    throw InputError(what, fmt::format("{}: dataset `{}`{}", shown_path(path_), shown(name), body),
                     remedy);
}

hdf5::Dataset Hdf5Table::open(std::string const& name) const {
    return hdf5::Dataset(sound(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), name));
}

std::vector<hsize_t> Hdf5Table::shape_of(hdf5::Dataset const& data, std::string const& name) const {
    hdf5::Space const space(sound(H5Dget_space(data.get()), name));
    std::vector<hsize_t> shape(
        static_cast<std::size_t>(sound(H5Sget_simple_extent_ndims(space.get()), name)));
    sound(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), name);
    return shape;
}

void Hdf5Table::refuse_unless_numbers(hdf5::Dataset const& data, std::string const& name) const {
    hdf5::Type const type(sound(H5Dget_type(data.get()), name));
    if (!is_number(type))
        refuse(name, whole, "the dataset contains no numbers", "store it as float64");
    refuse_large_chunks(data, name);
}

/// Refuses chunks larger than `largest_chunk`. HDF5 allocates the memory of a chunk whether or not
/// the file holds it.
void Hdf5Table::refuse_large_chunks(hdf5::Dataset const& data, std::string const& name) const {
    hdf5::Type const type(sound(H5Dget_type(data.get()), name));
    hsize_t extent[H5S_MAX_RANK], chunk = H5Tget_size(type.get());
    hdf5::Properties const how(sound(H5Dget_create_plist(data.get()), name));
    if (H5Pget_layout(how.get()) != H5D_CHUNKED) return;
    int const rank = sound(H5Pget_chunk(how.get(), H5S_MAX_RANK, extent), name);
    for (int i = 0; i < rank && chunk <= largest_chunk; ++i) chunk *= extent[i];
    if (chunk > largest_chunk)
        refuse(name, whole,
               "a chunk of the dataset is larger than a gigabyte, which is read at once",
               "write it in smaller chunks");
}

void Hdf5Table::read_block(hdf5::Dataset const& data, std::string const& name,
                           std::vector<hsize_t> const& shape, std::size_t first, std::size_t count,
                           hid_t type, void* values) const {
    std::vector<hsize_t> start(shape.size(), 0), extent = shape;
    start[0] = first, extent[0] = count;
    hdf5::Space const file(sound(H5Dget_space(data.get()), name));
    sound(H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(),
                              nullptr),
          name);
    hdf5::Space const memory(
        sound(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), name));
    sound(H5Dread(data.get(), type, memory.get(), file.get(), H5P_DEFAULT, values), name);
}

}  // namespace catena::scene
