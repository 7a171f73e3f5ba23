// What a file of HDF5 holds, times of writing aside.
#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <map>
#include <string>
#include <vector>

#include "io/hdf5_handle.hpp"

namespace catena::test {

/// Of every dataset of a file, by its first name: `step` has many.
using DatasetBits = std::map<std::string, std::vector<char>>;
inline herr_t add_bits(hid_t root, char const* name, H5O_info_t const* info, void* bits) {
    if (info->type != H5O_TYPE_DATASET) return 0;
    hdf5::Dataset const data(H5Dopen2(root, name, H5P_DEFAULT));
    hdf5::Space const space(H5Dget_space(data.get()));
    hdf5::Type const type(H5Dget_type(data.get()));
    std::vector<char>& values = (*static_cast<DatasetBits*>(bits))[name];
    values.resize(H5Tget_size(type.get()) *
                  static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    return H5Dread(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}
inline DatasetBits bits_of(std::string const& file) {
    hdf5::File const handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    DatasetBits bits;
    EXPECT_GE(H5Ovisit2(handle.get(), H5_INDEX_NAME, H5_ITER_INC, add_bits, &bits, H5O_INFO_BASIC),
              0)
        << file;
    return bits;
}

}  // namespace catena::test
