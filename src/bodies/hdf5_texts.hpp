// Texts of variable length in an HDF5 file, without HDF5's own reader of them: that one goes beyond
// its buffers where the file is damaged.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/hdf5_handle.hpp"

namespace catena::scene {

/// The texts of a dataset whose elements lie in the file one after the other, as h5py and HDF5's
/// tools write them. Members throw std::runtime_error, which says what is wrong, for another layout
/// and for damage. The file stays open longer than this.
class VariableTexts {
  public:
    VariableTexts(hdf5::File const& file, hdf5::Dataset const& data, std::size_t count);
    /// Text k, k < count.
    std::string at(std::size_t k);

  private:
    /// Objects of one collection of the global heap by their numbers.
    using Collection = std::map<unsigned, std::string>;
    std::string bytes(std::uint64_t from, std::uint64_t count) const;
    Collection const& collection(std::uint64_t address);
    Collection parsed(std::uint64_t at);

    int descriptor_ = -1;         // HDF5's
    std::uint64_t base_ = 0;      // in the file, of the addresses that it holds
    std::uint64_t elements_ = 0;  // where they begin in the file
    std::uint64_t size_ = 0;      // of the file
    std::uint64_t parsed_ = 0;    // bytes of collections so far
    std::map<std::uint64_t, Collection> collections_;
};

}  // namespace catena::scene
