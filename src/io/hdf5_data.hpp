// Attributes, fixed arrays and growing series in an HDF5 file: what trajectory and checkpoint are
// made of.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/hdf5_handle.hpp"

namespace catena::hdf5 {

/// An object of a file, with what messages say of it. The names outlive the Place.
struct Place {
    hid_t id;
    std::string const& file;
    std::string const& doing;  // "write the trajectory"
};

Group make_group(Place const&, std::string const& name);
bool has(Place const&, std::string const& name);

void put_attribute(Place const&, std::string const& name, std::span<std::int64_t const> values);
void put_attribute(Place const&, std::string const& name, std::int64_t value);
/// Fixed length, as H5MD's readers want the strings of /h5md.
void put_text(Place const&, std::string const& name, std::string_view text);
void put_texts(Place const&, std::string const& name, std::span<std::string const> texts);
/// Variable length, UTF-8: MDAnalysis refuses fixed-length units.
void put_unit(Place const&, std::string const& unit);
/// A string attribute; "" when it is absent or no string, or of variable length: HDF5 breaks where
/// such texts are damaged.
std::string get_text(Place const&, std::string const& name);

Dataset put_array(Place const&, std::string const& name, hid_t type, void const* values,
                  std::span<hsize_t const> shape);
Dataset put_array(Place const&, std::string const& name, std::span<double const> values);
Dataset put_array(Place const&, std::string const& name, std::span<std::int64_t const> values);
Dataset put_array(Place const&, std::string const& name, std::span<std::string const> texts);

/// [frames][row...]: a chunked dataset that grows by whole rows.
class Series {
  public:
    Series() = default;
    static Series create(Place const&, std::string const& name, hid_t type,
                         std::vector<hsize_t> row);
    static Series open(Place const&, std::string const& name, hid_t type);
    /// Entries along a row's first extent.
    struct Part {
        hsize_t first, count;
    };
    /// Writes row `frame`, growing to frame + 1 rows; where `values` is null it only grows.
    void put(Place const&, hsize_t frame, void const* values);
    /// Of that row these parts, which follow one another in the row as they do in `values`.
    /// `transfer`: of the file's writers.
    void put(Place const&, hsize_t frame, std::span<Part const> parts, void const* values,
             hid_t transfer);
    /// Bytes that row `frame` adds to the file.
    hsize_t growth(Place const&, hsize_t frame) const;
    /// Whether all ranks can write into it: its room is there before anybody writes.
    bool is_for_all(Place const&) const;
    /// Leaves the first `frames` rows.
    void cut(Place const&, hsize_t frames);
    hsize_t frames(Place const&) const;
    /// Reads a number of the last row, to where HDF5's index of rows leads.
    void look_at_last(Place const&) const;
    std::vector<hsize_t> const& row() const { return row_; }
    hid_t get() const { return data_.get(); }
    explicit operator bool() const { return static_cast<bool>(data_); }
    void close(Place const&);
    void release() { data_.release(); }

  private:
    /// The file's space of so many rows.
    Space grown(Place const&, hsize_t frames);
    Properties creation(Place const&) const;
    void write(Place const&, Space const& in_file, void const* values, hid_t transfer);

    Dataset data_;
    hid_t type_ = H5I_INVALID_HID;  // a native type of the library, not owned
    std::vector<hsize_t> row_;
};

}  // namespace catena::hdf5
