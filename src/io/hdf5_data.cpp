// Implements attributes, arrays and series by calls of the HDF5 C library.
#include "io/hdf5_data.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace catena::hdf5 {
namespace {

constexpr hsize_t chunk_bytes = 1 << 18;  // about this size
constexpr hsize_t most_frames_in_chunk = 1024;

/// Type of strings of `length` bytes, or of variable length for H5T_VARIABLE.
Type text_type(std::size_t length, Place const& place) {
    Type type(check(H5Tcopy(H5T_C_S1), place.file, place.doing));
    check(H5Tset_size(type.get(), length), place.file, place.doing);
    return type;
}

/// Dataspace of a single element.
Space scalar(Place const& place) {
    return Space(check(H5Screate(H5S_SCALAR), place.file, place.doing));
}

/// Dataspace of fixed shape.
Space simple(Place const& place, std::span<hsize_t const> shape) {
    return Space(check(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       place.file, place.doing));
}

/// Creates an attribute and writes its values. Error messages name the attribute.
void put(Place const& place, std::string const& name, hid_t type, Space const& space,
         void const* values) {
    Attribute attribute(
        check(H5Acreate2(place.id, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
              place.file + ", " + name, place.doing));
    check(H5Awrite(attribute.get(), type, values), place.file + ", " + name, place.doing);
}

/// Joins strings, each padded to the length of the longest. Returns that length and the characters.
std::pair<std::size_t, std::string> pack(std::span<std::string const> texts) {
    std::size_t length = 1;
    for (std::string const& text : texts) length = std::max(length, text.size() + 1);
    std::string packed;
    for (std::string const& text : texts) packed += text + std::string(length - text.size(), '\0');
    return {length, packed};
}

/// Shape of chunks of about 256 kB. They hold whole frames if these are small, and part of a frame
/// if it is large.
std::vector<hsize_t> chunk_for(std::vector<hsize_t> const& row, std::size_t element) {
    hsize_t const row_bytes = std::max<hsize_t>(
        1, std::accumulate(row.begin(), row.end(), hsize_t{element}, std::multiplies<>()));
    std::vector<hsize_t> chunk{
        std::clamp<hsize_t>(chunk_bytes / row_bytes, 1, most_frames_in_chunk)};
    chunk.insert(chunk.end(), row.begin(), row.end());
    if (!row.empty() && row_bytes > chunk_bytes)
        chunk[1] = std::max<hsize_t>(1, row[0] / (1 + row_bytes / chunk_bytes));
    for (hsize_t& extent : chunk) extent = std::max<hsize_t>(extent, 1);
    return chunk;
}

}  // namespace

Group make_group(Place const& place, std::string const& name) {
    return Group(check(H5Gcreate2(place.id, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       place.file + ", " + name, place.doing));
}

bool has(Place const& place, std::string const& name) {
    // H5Lexists fails if a group on the path is missing, which also means "no" here.
    for (std::size_t end = name.find('/'); end != std::string::npos; end = name.find('/', end + 1))
        if (H5Lexists(place.id, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(place.id, name.c_str(), H5P_DEFAULT) > 0;
}

void put_attribute(Place const& place, std::string const& name,
                   std::span<std::int64_t const> values) {
    hsize_t const count = values.size();
    put(place, name, H5T_NATIVE_INT64, simple(place, std::span(&count, 1)), values.data());
}

void put_attribute(Place const& place, std::string const& name, std::int64_t value) {
    put(place, name, H5T_NATIVE_INT64, scalar(place), &value);
}

void put_text(Place const& place, std::string const& name, std::string_view text) {
    std::string const terminated(text);
    put(place, name, text_type(terminated.size() + 1, place).get(), scalar(place),
        terminated.c_str());
}

void put_reference(Place const& place, std::string const& name, Place const& object) {
    hobj_ref_t reference{};
    check(H5Rcreate(&reference, object.id, ".", H5R_OBJECT, H5I_INVALID_HID), place.file,
          place.doing);
    put(place, name, H5T_STD_REF_OBJ, scalar(place), &reference);
}

void put_texts(Place const& place, std::string const& name, std::span<std::string const> texts) {
    auto const [length, packed] = pack(texts);
    hsize_t const count = texts.size();
    put(place, name, text_type(length, place).get(), simple(place, std::span(&count, 1)),
        packed.data());
}

void put_unit(Place const& place, std::string const& unit) {
    Type type = text_type(H5T_VARIABLE, place);
    check(H5Tset_cset(type.get(), H5T_CSET_UTF8), place.file, place.doing);
    char const* const text = unit.c_str();
    put(place, "unit", type.get(), scalar(place), static_cast<void const*>(&text));
}

std::string get_text(Place const& place, std::string const& name) {
    if (H5Aexists(place.id, name.c_str()) <= 0) return "";
    Attribute const attribute(H5Aopen(place.id, name.c_str(), H5P_DEFAULT));
    Type const stored(H5Aget_type(attribute.get()));
    if (!attribute || !stored || H5Tget_class(stored.get()) != H5T_STRING ||
        H5Tis_variable_str(stored.get()) > 0)
        return "";
    std::string text(H5Tget_size(stored.get()), '\0');
    if (H5Aread(attribute.get(), stored.get(), text.data()) < 0) return "";
    return text.substr(0, text.find('\0'));
}

Dataset put_array(Place const& place, std::string const& name, hid_t type, void const* values,
                  std::span<hsize_t const> shape) {
    std::string const where = place.file + ", " + name;
    Space const space = simple(place, shape);
    Dataset data(check(H5Dcreate2(place.id, name.c_str(), type, space.get(), H5P_DEFAULT,
                                  H5P_DEFAULT, H5P_DEFAULT),
                       where, place.doing));
    bool const empty =
        std::any_of(shape.begin(), shape.end(), [](hsize_t extent) { return extent == 0; });
    if (!empty)
        check(H5Dwrite(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), where,
              place.doing);
    return data;
}

Dataset put_array(Place const& place, std::string const& name, std::span<double const> values) {
    hsize_t const count = values.size();
    return put_array(place, name, H5T_NATIVE_DOUBLE, values.data(), std::span(&count, 1));
}

Dataset put_array(Place const& place, std::string const& name,
                  std::span<std::int64_t const> values) {
    hsize_t const count = values.size();
    return put_array(place, name, H5T_NATIVE_INT64, values.data(), std::span(&count, 1));
}

Dataset put_array(Place const& place, std::string const& name, std::span<std::string const> texts) {
    auto const [length, packed] = pack(texts);
    hsize_t const count = texts.size();
    return put_array(place, name, text_type(length, place).get(), packed.data(),
                     std::span(&count, 1));
}

Series Series::create(Place const& place, std::string const& name, hid_t type,
                      std::vector<hsize_t> row) {
    std::vector<hsize_t> shape{0}, limit{H5S_UNLIMITED};
    shape.insert(shape.end(), row.begin(), row.end());
    limit.insert(limit.end(), row.begin(), row.end());
    auto const chunk = chunk_for(row, H5Tget_size(type));
    Space const space(
        check(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), limit.data()),
              place.file, place.doing));
    Properties const properties(check(H5Pcreate(H5P_DATASET_CREATE), place.file, place.doing));
    check(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), place.file,
          place.doing);
    // The file is the same whoever writes it. Parallel HDF5 must know where a row lies before ranks
    // write it, and every row is written completely.
    check(H5Pset_alloc_time(properties.get(), H5D_ALLOC_TIME_EARLY), place.file, place.doing);
    check(H5Pset_fill_time(properties.get(), H5D_FILL_TIME_NEVER), place.file, place.doing);
    Series series;
    series.type_ = type;
    series.row_ = std::move(row);
    series.data_ = Dataset(check(H5Dcreate2(place.id, name.c_str(), type, space.get(), H5P_DEFAULT,
                                            properties.get(), H5P_DEFAULT),
                                 place.file + ", " + name, place.doing));
    return series;
}

Series Series::open(Place const& place, std::string const& name, hid_t type) {
    Series series;
    series.type_ = type;
    series.data_ = Dataset(check(H5Dopen2(place.id, name.c_str(), H5P_DEFAULT),
                                 place.file + ", " + name, place.doing));
    Space const space(check(H5Dget_space(series.data_.get()), place.file, place.doing));
    std::vector<hsize_t> shape(
        static_cast<std::size_t>(std::max(1, H5Sget_simple_extent_ndims(space.get()))));
    check(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), place.file, place.doing);
    series.row_.assign(shape.begin() + 1, shape.end());
    return series;
}

Space Series::grown(Place const& place, hsize_t frames) {
    cut(place, frames);
    return Space(check(H5Dget_space(data_.get()), place.file, place.doing));
}

void Series::put(Place const& place, hsize_t frame, void const* values) {
    if (values == nullptr) return cut(place, frame + 1);
    Part const whole{0, row_.empty() ? 1 : row_[0]};
    put(place, frame, std::span(&whole, 1), values, H5P_DEFAULT);
}

void Series::put(Place const& place, hsize_t frame, std::span<Part const> parts, void const* values,
                 hid_t transfer) {
    Space const in_file = grown(place, frame + 1);
    check(H5Sselect_none(in_file.get()), place.file, place.doing);
    std::vector<hsize_t> start{frame}, count{1};
    start.resize(row_.size() + 1, 0);
    count.insert(count.end(), row_.begin(), row_.end());
    int blocks = 0;
    for (Part const& part : parts) {
        if (part.count == 0) continue;
        if (!row_.empty()) {
            start[1] = part.first;
            count[1] = part.count;
        }
        check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_OR, start.data(), nullptr, count.data(),
                                  nullptr),
              place.file, place.doing);
        ++blocks;
    }
    // HDF5 copies a single block as a whole if memory has its shape, and value by value otherwise.
    if (blocks != 1)
        count = {static_cast<hsize_t>(
            check(H5Sget_select_npoints(in_file.get()), place.file, place.doing))};
    Space const in_memory = simple(place, count);
    check(H5Dwrite(data_.get(), type_, in_memory.get(), in_file.get(), transfer, values),
          place.file, place.doing);
}

Properties Series::creation(Place const& place) const {
    return Properties(check(H5Dget_create_plist(data_.get()), place.file, place.doing));
}

hsize_t Series::growth(Place const& place, hsize_t frame) const {
    std::vector<hsize_t> chunk(row_.size() + 1);
    check(H5Pget_chunk(creation(place).get(), static_cast<int>(chunk.size()), chunk.data()),
          place.file, place.doing);
    if (frame % chunk[0] != 0) return 0;
    hsize_t bytes = chunk[0] * H5Tget_size(type_);
    for (std::size_t i = 0; i < row_.size(); ++i)
        bytes *= (row_[i] + chunk[i + 1] - 1) / chunk[i + 1] * chunk[i + 1];
    return bytes;
}

bool Series::is_for_all(Place const& place) const {
    H5D_alloc_time_t time = H5D_ALLOC_TIME_DEFAULT;
    check(H5Pget_alloc_time(creation(place).get(), &time), place.file, place.doing);
    return time == H5D_ALLOC_TIME_EARLY;
}

void Series::cut(Place const& place, hsize_t frames) {
    std::vector<hsize_t> shape{frames};
    shape.insert(shape.end(), row_.begin(), row_.end());
    check(H5Dset_extent(data_.get(), shape.data()), place.file, place.doing);
}

hsize_t Series::frames(Place const& place) const {
    Space const space(check(H5Dget_space(data_.get()), place.file, place.doing));
    std::vector<hsize_t> shape(row_.size() + 1);
    check(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), place.file, place.doing);
    return shape[0];
}

void Series::look_at_last(Place const& place) const {
    hsize_t const all = frames(place);
    if (all == 0 || std::find(row_.begin(), row_.end(), 0) != row_.end()) return;
    std::vector<hsize_t> start{all - 1}, one(row_.size() + 1, 1);
    start.resize(row_.size() + 1, 0);
    Space const in_file(check(H5Dget_space(data_.get()), place.file, place.doing)),
        in_memory = simple(place, one);
    check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, one.data(),
                              nullptr),
          place.file, place.doing);
    double number = 0;
    check(H5Dread(data_.get(), type_, in_memory.get(), in_file.get(), H5P_DEFAULT, &number),
          place.file, place.doing);
}

void Series::close(Place const& place) { check(data_.close(), place.file, place.doing); }

}  // namespace catena::hdf5
