// Reader of variable-length texts in an HDF5 file. HDF5's own reader overruns its buffers if the
// file is damaged.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/hdf5_handle.hpp"

namespace catena::scene {

/// The texts of a dataset whose elements lie contiguously in the file, as h5py and HDF5's tools
/// write them. Members throw std::runtime_error with the reason for another layout and for damage.
/// The file must stay open longer than this object.
class VariableTexts {
  public:
    /// Throws if the elements are not contiguous in this file. `count` is the number of texts.
    VariableTexts(hdf5::File const& file, hdf5::Dataset const& data, std::size_t count);
    /// Returns text k; precondition: k < count.
    std::string at(std::size_t k);

  private:
    /// Objects of one collection of the global heap, by their numbers.
    using Collection = std::map<unsigned, std::string>;
    /// Reads `count` bytes from position `from` of the file.
    std::string bytes(std::uint64_t from, std::uint64_t count) const;
    /// Returns the collection at that address, parsed at first use.
    Collection const& collection(std::uint64_t address);
    /// Parses the collection at address `at` and checks all its sizes.
    Collection parsed(std::uint64_t at);

    int descriptor_ = -1;         // file descriptor, owned by HDF5
    std::uint64_t base_ = 0;      // offset in the file of the addresses that it holds
    std::uint64_t elements_ = 0;  // offset in the file of the first element
    std::uint64_t size_ = 0;      // size of the file, bytes
    std::uint64_t parsed_ = 0;    // size of all collections parsed so far, bytes
    std::map<std::uint64_t, Collection> collections_;
};

}  // namespace catena::scene
