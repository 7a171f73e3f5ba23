// Implements the reader of DCD files: Fortran records, each between two copies of its length.
#include "frames/dcd_file.hpp"

#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "error.hpp"

namespace catena {
namespace {

static_assert(std::endian::native == std::endian::little, "records are read as they lie");

constexpr double nm_per_angstrom = 0.1;
constexpr std::uint64_t mark = 4;  // bytes of a record's length
constexpr std::size_t control_bytes = 84;
constexpr double right_within = 1e-3;  // degrees, or cosines

template <class Value>
Value value_at(std::string const& bytes, std::size_t offset) {
    Value value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// The first word of a head, whose bytes may be anything, as text.
std::string word_in(std::string const& head) {
    std::string word = head.substr(0, 4);
    for (char& c : word)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '?';
    return word;
}

/// True for a right angle, in degrees or as a cosine.
bool is_right(double angle) {
    return std::abs(angle - 90) < right_within || std::abs(angle) < right_within;
}

}  // namespace

DcdFile::DcdFile(std::string const& file) : name_(file) {
    std::error_code failed;
    size_ = std::filesystem::file_size(file, failed);
    if (failed || !std::filesystem::is_regular_file(file, failed))
        throw InputError("there is no trajectory", file, "check the path");
    if (size_ < control_bytes + 2 * mark) damaged("it is shorter than a head");
    std::uint64_t offset = 0;
    auto const length = value_at<std::uint32_t>(bytes(0, mark), 0);
    if (length != control_bytes)
        throw InputError("it is no DCD file of this machine's byte order", file,
                         "convert it, for example with MDAnalysis");
    std::string const head = record(offset);
    if (head.compare(0, 4, "CORD") != 0)
        throw InputError("it holds no positions: its head says `" + word_in(head) + "`", file,
                         "give a DCD file of coordinates");
    std::array<std::int32_t, 20> control{};
    std::memcpy(control.data(), head.data() + 4, sizeof control);
    bool const charmm = control[19] != 0, fourth = charmm && control[11] != 0;
    has_cell_ = charmm && control[10] != 0;
    if (control[8] != 0)
        throw InputError("its frames leave out fixed atoms", file,
                         "write the trajectory with all atoms");
    record(offset);  // titles
    std::string const count = record(offset);
    if (count.size() != mark || value_at<std::int32_t>(count, 0) < 1)
        damaged("its number of atoms is not sound");
    sites_ = static_cast<std::size_t>(value_at<std::int32_t>(count, 0));
    first_frame_ = offset;
    frame_size_ = (fourth ? 4 : 3) * (sites_ * sizeof(float) + 2 * mark) +
                  (has_cell_ ? 6 * sizeof(double) + 2 * mark : 0);
    frames_ = static_cast<std::size_t>((size_ - first_frame_) / frame_size_);
    if (frames_ == 0)
        throw InputError("the trajectory has no frames", file, "let the run reach its first one");
}

Snapshot DcdFile::read(std::size_t frame) const {
    std::uint64_t offset = first_frame_ + frame * frame_size_;
    Snapshot snapshot;
    if (has_cell_) snapshot.box = edges_in(record(offset));
    snapshot.position.resize(sites_);
    for (int i = 0; i < 3; ++i) {
        std::string const coordinates = record(offset);
        if (coordinates.size() != sites_ * sizeof(float))
            damaged("frame " + std::to_string(frame) + " has another number of atoms");
        for (std::size_t k = 0; k < sites_; ++k) {
            double const x = static_cast<double>(value_at<float>(coordinates, k * sizeof(float)));
            if (!std::isfinite(x))
                damaged("frame " + std::to_string(frame) + " holds numbers that are not finite");
            snapshot.position[k][i] = nm_per_angstrom * x;
        }
    }
    return snapshot;
}

std::string DcdFile::bytes(std::uint64_t offset, std::uint64_t count) const {
    std::ifstream in(name_, std::ios::binary);
    std::string found(count, '\0');
    in.seekg(static_cast<std::streamoff>(offset));
    if (!in.read(found.data(), static_cast<std::streamsize>(count)))
        damaged("it cannot be read to its end");
    return found;
}

std::string DcdFile::record(std::uint64_t& offset) const {
    if (offset + 2 * mark > size_) damaged("it ends too early");
    std::uint64_t const length = value_at<std::uint32_t>(bytes(offset, mark), 0);
    if (length > size_ || offset + length + 2 * mark > size_) damaged("it ends too early");
    std::string found = bytes(offset + mark, length + mark);
    if (value_at<std::uint32_t>(found, length) != length)
        damaged("a record does not end as it begins");
    found.resize(length);
    offset += length + 2 * mark;
    return found;
}

void DcdFile::damaged(std::string const& how) const {
    throw InputError("the DCD file is damaged: " + how, name_, "write it again");
}

/// Reads the edges of the cell A, gamma, B, beta, alpha, C in Angstrom. Edges of zero mean that
/// there is no box.
std::optional<Vec3> DcdFile::edges_in(std::string const& cell) const {
    if (cell.size() != 6 * sizeof(double)) damaged("its box has another form");
    std::array<double, 6> value{};
    std::memcpy(value.data(), cell.data(), sizeof value);
    if (value[0] == 0 && value[2] == 0 && value[5] == 0) return std::nullopt;
    Vec3 const edges{
        {nm_per_angstrom * value[0], nm_per_angstrom * value[2], nm_per_angstrom * value[5]}};
    for (double const edge : edges.data)
        if (!(edge > 0) || !std::isfinite(edge)) damaged("an edge of its box is not positive");
    if (!is_right(value[1]) || !is_right(value[3]) || !is_right(value[4]))
        throw InputError("its box is not rectangular", name_,
                         "give a trajectory of a rectangular box");
    return edges;
}

}  // namespace catena
