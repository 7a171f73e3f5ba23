// Datasets whose rows are bodies, read in blocks so that nothing is held twice.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/hdf5_handle.hpp"

namespace catena::scene {

class Hdf5Table {
  public:
    /// Opens the file; the rows are counted in the dataset `counted`. InputError where there is
    /// none.
    Hdf5Table(std::string const& path, std::string const& counted);

    std::size_t rows() const { return rows_; }
    bool has(std::string const& name) const;
    std::vector<std::string> names() const;

    /// Calls `read(k, numbers of row k)` for every row, whose shape is one of `shapes` ({}: one
    /// number). InputError for any other shape, for what are no numbers and for numbers that are
    /// not finite. Returns the numbers a row.
    using Shape = std::vector<hsize_t>;
    using Read = std::function<void(std::size_t, double const*, std::size_t)>;
    std::size_t for_each(std::string const& name, std::vector<Shape> const& shapes,
                         Read const& read) const;
    /// Whole numbers, or texts where `is_text`.
    bool is_text(std::string const& name) const;
    using ReadText = std::function<void(std::size_t, std::string const&)>;
    void for_each_text(std::string const& name, ReadText const& read) const;
    /// A lone vector of three.
    bool vector(std::string const& name, double (&values)[3]) const;

    /// InputError at row k (from 0), or at the dataset where k is `whole`.
    static constexpr std::size_t whole = static_cast<std::size_t>(-1);
    [[noreturn]] void refuse(std::string const& name, std::size_t k, std::string const& what,
                             std::string const& remedy) const;

  private:
    hdf5::Dataset open(std::string const& name) const;
    std::vector<hsize_t> shape_of(hdf5::Dataset const& data, std::string const& name) const;
    void refuse_too_large(std::string const& name) const;
    void refuse_unless_numbers(hdf5::Dataset const& data, std::string const& name) const;
    void refuse_large_chunks(hdf5::Dataset const& data, std::string const& name) const;
    void for_each_variable_text(hdf5::Dataset const& data, std::string const& name,
                                ReadText const& read) const;
    void read_block(hdf5::Dataset const& data, std::string const& name,
                    std::vector<hsize_t> const& shape, std::size_t first, std::size_t count,
                    hid_t type, void* values) const;
    /// InputError with HDF5's own reason where the status is negative.
    template <class Status>
    Status sound(Status status, std::string const& name) const;

    hdf5::Quiet quiet_;
    std::string path_;
    hdf5::File file_;
    std::size_t rows_ = 0;
};

}  // namespace catena::scene
