#include "scene/hdf5_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "error.hpp"
#include "scene/node.hpp"

namespace catena::scene {

namespace {

std::size_t constexpr rows_a_block = 1 << 16;

std::string shape_text(std::vector<hsize_t> const& shape) { return fmt::format("[{}]", fmt::join(shape, ", ")); }

}  // namespace

template <class Status>
Status Hdf5Table::sound(Status status, std::string const& name) const {
    if (status < 0) refuse(name, whole, "the dataset cannot be read: " + shown(hdf5::cause()), "check the file");
    return status;
}

Hdf5Table::Hdf5Table(std::string const& path, std::string const& counted) : path_(path) {
    file_ = hdf5::File(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!file_) throw InputError("the file is not there or no HDF5 file: " + shown(hdf5::cause()), shown_path(path), "check the path");
    if (!has(counted)) refuse(counted, whole, "the dataset is missing", "add it: its rows are the bodies");
    std::vector<hsize_t> const shape = shape_of(open(counted), counted);
    if (shape.empty() || shape[0] == 0) refuse(counted, whole, "the dataset is empty", "give at least one body");
    rows_ = shape[0];
}

bool Hdf5Table::has(std::string const& name) const { return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0; }

std::vector<std::string> Hdf5Table::names() const {
    std::vector<std::string> names;
    H5G_info_t info{};
    sound(H5Gget_info(file_.get(), &info), "/");
    for (hsize_t i = 0; i < info.nlinks; ++i) {
        char name[256] = {};
        sound(H5Lget_name_by_idx(file_.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT), "/");
        names.emplace_back(name);
    }
    return names;
}

std::size_t Hdf5Table::for_each(std::string const& name, std::vector<Shape> const& shapes, Read const& read) const {
    hdf5::Dataset const data = open(name);
    std::vector<hsize_t> const shape = shape_of(data, name);
    Shape const row(shape.begin() + (shape.empty() ? 0 : 1), shape.end());
    if (shape.empty() || shape[0] != rows_ || std::find(shapes.begin(), shapes.end(), row) == shapes.end()) {
        std::string wanted;
        for (Shape one : shapes) {
            one.insert(one.begin(), rows_);
            wanted += (wanted.empty() ? "" : " or ") + shape_text(one);
        }
        refuse(name, whole, fmt::format("the dataset has shape {}, not {}", shape_text(shape), wanted), "give one row a body");
    }
    refuse_unless_numbers(data, name);
    std::size_t width = 1;
    for (hsize_t const extent : row) width *= extent;
    std::vector<double> block(std::min(rows_, rows_a_block) * width);
    for (std::size_t first = 0; first < rows_; first += rows_a_block) {
        std::size_t const count = std::min(rows_a_block, rows_ - first);
        read_block(data, name, shape, first, count, H5T_NATIVE_DOUBLE, block.data());
        for (std::size_t i = 0; i < count; ++i) {
            double const* const values = block.data() + i * width;
            for (std::size_t j = 0; j < width; ++j)
                if (!std::isfinite(values[j])) refuse(name, first + i, fmt::format("{} is not finite", values[j]), "give finite numbers");
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

void Hdf5Table::for_each_text(std::string const& name, std::function<void(std::size_t, std::string const&)> const& read) const {
    hdf5::Dataset const data = open(name);
    std::vector<hsize_t> const shape = shape_of(data, name);
    if (shape != std::vector<hsize_t>{rows_})
        refuse(name, whole, fmt::format("the dataset has shape {}, not [{}]", shape_text(shape), rows_), "give one text a body");
    hdf5::Type const type(sound(H5Dget_type(data.get()), name));
    bool const variable = H5Tis_variable_str(type.get()) > 0;
    std::size_t const length = variable ? sizeof(char*) : H5Tget_size(type.get());
    std::vector<char> block(std::min(rows_, rows_a_block) * length);
    for (std::size_t first = 0; first < rows_; first += rows_a_block) {
        std::size_t const count = std::min(rows_a_block, rows_ - first);
        read_block(data, name, shape, first, count, type.get(), block.data());
        std::vector<std::string> texts;
        for (std::size_t i = 0; i < count; ++i) {
            char const* text = block.data() + i * length;
            if (variable) std::memcpy(static_cast<void*>(&text), block.data() + i * length, sizeof text);
            texts.emplace_back(text ? std::string(text, variable ? std::strlen(text) : strnlen(text, length)) : "");
        }
        if (variable) {
            hsize_t const extent = count;
            hdf5::Space const memory(sound(H5Screate_simple(1, &extent, nullptr), name));
            sound(H5Dvlen_reclaim(type.get(), memory.get(), H5P_DEFAULT, block.data()), name);
        }
        for (std::size_t i = 0; i < count; ++i) read(first + i, texts[i]);
    }
}

bool Hdf5Table::vector(std::string const& name, double (&values)[3]) const {
    if (!has(name)) return false;
    hdf5::Dataset const data = open(name);
    std::vector<hsize_t> const shape = shape_of(data, name);
    if (shape != std::vector<hsize_t>{3})
        refuse(name, whole, fmt::format("the dataset has shape {}, not [3]", shape_text(shape)), "give three numbers");
    refuse_unless_numbers(data, name);
    sound(H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
    for (double const value : values)
        if (!std::isfinite(value)) refuse(name, whole, fmt::format("{} is not finite", value), "give finite numbers");
    return true;
}

void Hdf5Table::refuse(std::string const& name, std::size_t k, std::string const& what, std::string const& remedy) const {
    std::string const body = k == whole ? "" : fmt::format(", body {}", k + 1);
    throw InputError(what, fmt::format("{}: dataset `{}`{}", shown_path(path_), shown(name), body), remedy);
}

hdf5::Dataset Hdf5Table::open(std::string const& name) const {
    return hdf5::Dataset(sound(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), name));
}

std::vector<hsize_t> Hdf5Table::shape_of(hdf5::Dataset const& data, std::string const& name) const {
    hdf5::Space const space(sound(H5Dget_space(data.get()), name));
    std::vector<hsize_t> shape(static_cast<std::size_t>(sound(H5Sget_simple_extent_ndims(space.get()), name)));
    sound(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), name);
    return shape;
}

void Hdf5Table::refuse_unless_numbers(hdf5::Dataset const& data, std::string const& name) const {
    hdf5::Type const type(sound(H5Dget_type(data.get()), name));
    H5T_class_t const kind = H5Tget_class(type.get());
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) refuse(name, whole, "the dataset holds no numbers", "store it as float64");
}

void Hdf5Table::read_block(hdf5::Dataset const& data, std::string const& name, std::vector<hsize_t> const& shape, std::size_t first,
                           std::size_t count, hid_t type, void* values) const {
    std::vector<hsize_t> start(shape.size(), 0), extent = shape;
    start[0] = first, extent[0] = count;
    hdf5::Space const file(sound(H5Dget_space(data.get()), name));
    sound(H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr), name);
    hdf5::Space const memory(sound(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), name));
    sound(H5Dread(data.get(), type, memory.get(), file.get(), H5P_DEFAULT, values), name);
}

}  // namespace catena::scene
