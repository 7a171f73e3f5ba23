// Attributes, fixed arrays and growing series in an HDF5 file. Trajectories and checkpoints are
// built from them. Failures of HDF5 throw ComputationError "cannot <doing> (<file>): <cause>".
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/hdf5_handle.hpp"

namespace catena::hdf5 {

/// HDF5 object together with the file and the action that error messages name. The names must
/// outlive the Place.
struct Place {
    hid_t id;
    std::string const& file;
    std::string const& doing;  // "write the trajectory"
};

Group make_group(Place const&, std::string const& name);
/// True if the path `name`, e.g. "h5md/creator", exists below the object.
bool has(Place const&, std::string const& name);

/// Writes an attribute of 64-bit integers: one-dimensional for a span, scalar for a single value.
void put_attribute(Place const&, std::string const& name, std::span<std::int64_t const> values);
void put_attribute(Place const&, std::string const& name, std::int64_t value);
/// Writes a scalar string of fixed length, which H5MD's readers require of the strings in /h5md.
void put_text(Place const&, std::string const& name, std::string_view text);
/// Writes a one-dimensional attribute of strings, padded to one length.
void put_texts(Place const&, std::string const& name, std::span<std::string const> texts);
/// Writes a scalar attribute that refers to an object of the same file.
void put_reference(Place const&, std::string const& name, Place const& object);
/// Writes the attribute `unit` with variable length in UTF-8, because MDAnalysis refuses
/// fixed-length units.
void put_unit(Place const&, std::string const& unit);
/// Returns a string attribute, or "" if it is absent, no string, or of variable length. HDF5 reads
/// beyond its buffers on damaged texts of variable length.
std::string get_text(Place const&, std::string const& name);

/// Creates a dataset of fixed shape and writes `values` to it, unless an extent of the shape is 0.
Dataset put_array(Place const&, std::string const& name, hid_t type, void const* values,
                  std::span<hsize_t const> shape);
/// Creates a one-dimensional dataset. Strings are padded to one length.
Dataset put_array(Place const&, std::string const& name, std::span<double const> values);
Dataset put_array(Place const&, std::string const& name, std::span<std::int64_t const> values);
Dataset put_array(Place const&, std::string const& name, std::span<std::string const> texts);

/// Chunked dataset [frames][row...] that grows by whole rows.
class Series {
  public:
    Series() = default;
    /// Creates an empty series. `row`: shape of one row, empty for one scalar per frame.
    static Series create(Place const&, std::string const& name, hid_t type,
                         std::vector<hsize_t> row);
    /// Opens an existing series, whose row shape is read from the file.
    static Series open(Place const&, std::string const& name, hid_t type);
    /// Entries [first, first + count) along the first dimension of a row.
    struct Part {
        hsize_t first, count;
    };
    /// Writes row `frame` and grows the dataset to frame + 1 rows. A null `values` only grows it.
    void put(Place const&, hsize_t frame, void const* values);
    /// Writes only `parts` of row `frame`, in ascending order; `values` holds their entries without
    /// gaps. `transfer`: property list from Writers::transfer().
    void put(Place const&, hsize_t frame, std::span<Part const> parts, void const* values,
             hid_t transfer);
    /// Bytes that row `frame` adds to the file: the size of a new layer of chunks, or 0.
    hsize_t growth(Place const&, hsize_t frame) const;
    /// True if all ranks can write into the series: its space is allocated before any rank writes.
    bool is_for_all(Place const&) const;
    /// Shortens the dataset to its first `frames` rows.
    void cut(Place const&, hsize_t frames);
    hsize_t frames(Place const&) const;
    /// Reads one number of the last row, which makes HDF5 follow its index of chunks to that row. A
    /// trial detects damage of the index in this way (trial.hpp).
    void look_at_last(Place const&) const;
    std::vector<hsize_t> const& row() const { return row_; }
    hid_t get() const { return data_.get(); }
    explicit operator bool() const { return static_cast<bool>(data_); }
    /// Closes the dataset. Throws if data could not be written.
    void close(Place const&);
    /// Leaves the dataset open (Handle::release()).
    void release() { data_.release(); }

  private:
    /// Resizes the dataset to `frames` rows and returns its dataspace.
    Space grown(Place const&, hsize_t frames);
    Properties creation(Place const&) const;

    Dataset data_;
    hid_t type_ = H5I_INVALID_HID;  // a native type of the library, not owned
    std::vector<hsize_t> row_;      // shape of one row
};

}  // namespace catena::hdf5
