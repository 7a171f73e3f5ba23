// Datasets with one row per body. They are read in blocks, so that no dataset is held twice in
// memory.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/hdf5_handle.hpp"

namespace catena::scene {

/// Open file of body tables.
class Hdf5Table {
  public:
    /// Opens the file and counts the rows of the dataset `counted`. Throws InputError if the file
    /// or the dataset is missing.
    Hdf5Table(std::string const& path, std::string const& counted);

    /// Number of rows of the counted dataset, that is of bodies.
    std::size_t rows() const { return rows_; }
    /// True if the file has an object of that name at its root.
    bool has(std::string const& name) const;
    /// Names of all datasets and groups at the root of the file.
    std::vector<std::string> names() const;

    /// Calls `read(k, numbers, count)` for every row k. A row must have one of `shapes` ({}: one
    /// number). Throws InputError for any other shape, for other types than numbers and for numbers
    /// that are not finite. Returns the number of numbers per row.
    using Shape = std::vector<hsize_t>;
    using Read = std::function<void(std::size_t, double const*, std::size_t)>;
    std::size_t for_each(std::string const& name, std::vector<Shape> const& shapes,
                         Read const& read) const;
    /// True if the dataset holds texts rather than numbers.
    bool is_text(std::string const& name) const;
    /// Calls `read(k, text)` for every row k of a dataset of texts, of fixed or variable length.
    using ReadText = std::function<void(std::size_t, std::string const&)>;
    void for_each_text(std::string const& name, ReadText const& read) const;
    /// Reads a single vector of three; returns false if the dataset is absent.
    bool vector(std::string const& name, double (&values)[3]) const;

    /// Throws InputError for row k (from 0), or for the whole dataset if k is `whole`.
    static constexpr std::size_t whole = static_cast<std::size_t>(-1);
    [[noreturn]] void refuse(std::string const& name, std::size_t k, std::string const& what,
                             std::string const& remedy) const;

  private:
    /// Opens a dataset; throws InputError with HDF5's reason.
    hdf5::Dataset open(std::string const& name) const;
    /// Extents of the dataset; empty for a scalar.
    std::vector<hsize_t> shape_of(hdf5::Dataset const& data, std::string const& name) const;
    /// Throws InputError for more rows than the file can hold or the memory can take.
    void refuse_too_large(std::string const& name) const;
    /// Throws InputError for element types other than common number types.
    void refuse_unless_numbers(hdf5::Dataset const& data, std::string const& name) const;
    /// Refuses chunks larger than a gigabyte; HDF5 allocates whole chunks.
    void refuse_large_chunks(hdf5::Dataset const& data, std::string const& name) const;
    /// Reads texts of variable length without HDF5's reader, see VariableTexts.
    void for_each_variable_text(hdf5::Dataset const& data, std::string const& name,
                                ReadText const& read) const;
    /// Reads `count` rows from `first` on into `values`, converted to the memory type `type`.
    void read_block(hdf5::Dataset const& data, std::string const& name,
                    std::vector<hsize_t> const& shape, std::size_t first, std::size_t count,
                    hid_t type, void* values) const;
    /// Throws InputError with HDF5's own reason if the status is negative; returns it otherwise.
    template <class Status>
    Status sound(Status status, std::string const& name) const;

    /// Suppresses HDF5's own error output while the table is open.
    hdf5::Quiet quiet_;
    std::string path_;
    hdf5::File file_;
    std::size_t rows_ = 0;
};

}  // namespace catena::scene
