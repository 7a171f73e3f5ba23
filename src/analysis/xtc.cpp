// Implements XTC files: XDR (RFC 4506), all numbers big-endian in multiples of four bytes. Layout:
// https://manual.gromacs.org/current/reference-manual/file-formats.html#xtc
#include "analysis/xtc.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "analysis/xtc_coding.hpp"
#include "error.hpp"
#include "io/output_file.hpp"

namespace catena::analysis {
namespace {

constexpr std::int32_t magic = 1995;
constexpr std::size_t most_uncompressed = 9;  // sites
/// Largest coordinate in units of the precision.
constexpr double most_coordinate = INT32_MAX - 2;

/// Numbers of one frame as XDR.
class Xdr {
  public:
    void put(std::int32_t value) {
        auto const bits = static_cast<std::uint32_t>(value);
        for (int shift = 24; shift >= 0; shift -= 8) bytes_ += static_cast<char>(bits >> shift);
    }
    void put(double value) {
        put(static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(static_cast<float>(value))));
    }
    void put(Vec3 const& x) {
        for (double const value : x.data) put(value);
    }
    void put(Lattice const& x) {
        for (std::int32_t const value : x) put(value);
    }
    void put_opaque(std::string const& text) {
        bytes_ += text;
        bytes_.append((4 - text.size() % 4) % 4, '\0');
    }
    std::string const& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// One frame of the file to be written.
struct FramePlace {
    std::string const& file;
    std::size_t frame;
    double precision;
};

/// Rounds positions. Throws InputError for those that the format's integers cannot hold.
std::vector<Lattice> rounded(std::vector<Vec3> const& positions, FramePlace const& at) {
    std::vector<Lattice> all;
    all.reserve(positions.size());
    Vec3 least = positions.front(), most = least;
    for (Vec3 const& x : positions) {
        Lattice& to = all.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            double const value = x.data[i], number = std::round(value * at.precision);
            least.data[i] = std::min(least.data[i], value);
            most.data[i] = std::max(most.data[i], value);
            if (std::abs(number) <= most_coordinate)
                to[i] = static_cast<std::int32_t>(number);
            else
                throw InputError(
                    fmt::format("site {} of frame {} is at {:.4g} nm, and an XTC file of precision "
                                "{:g} holds coordinates up to {:.4g} nm",
                                all.size(), at.frame, value, at.precision,
                                most_coordinate / at.precision),
                    at.file, "choose a smaller --precision, or a DCD file");
        }
    }
    for (std::size_t i = 0; i < 3; ++i)
        if (std::round(most.data[i] * at.precision) - std::round(least.data[i] * at.precision) >
            static_cast<double>(most_extent))
            throw InputError(
                fmt::format("the sites of frame {} are up to {:.4g} nm apart, and an XTC file of "
                            "precision {:g} holds {:.4g} nm",
                            at.frame, most.data[i] - least.data[i], at.precision,
                            static_cast<double>(most_extent) / at.precision),
                at.file, "choose a smaller --precision, or a DCD file");
    return all;
}

void put_compressed(Xdr& out, std::vector<Vec3> const& positions, FramePlace const& at) {
    PackedPositions const packed = pack_positions(rounded(positions, at));
    if (packed.bits.size() > INT32_MAX)
        throw InputError(
            fmt::format("frame {} has more sites than a frame of an XTC file holds", at.frame),
            at.file, "read the trajectory itself");
    out.put(at.precision);
    out.put(packed.least);
    out.put(packed.most);
    out.put(packed.first_size);
    out.put(static_cast<std::int32_t>(packed.bits.size()));
    out.put_opaque(packed.bits);
}

/// Returns the bytes of a frame.
std::string frame_of(Snapshot const& snapshot, std::int64_t step, double time,
                     FramePlace const& at) {
    auto const sites = static_cast<std::int32_t>(snapshot.position.size());
    Xdr out;
    out.put(magic);
    out.put(sites);
    out.put(static_cast<std::int32_t>(step));
    out.put(time);
    Vec3 const edge = snapshot.box.value_or(Vec3::zero());
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) out.put(row == column ? edge[row] : 0.0);
    out.put(sites);
    if (snapshot.position.size() <= most_uncompressed)
        for (Vec3 const& x : snapshot.position) out.put(x);
    else
        put_compressed(out, snapshot.position, at);
    return out.bytes();
}

/// Refuses what the format cannot hold.
void refuse_unwritable(TrajectoryFile const& trajectory, ChosenFrames const& chosen) {
    if (trajectory.topology().si)
        throw InputError("an XTC file holds nm, and the trajectory is in m", trajectory.name(),
                         "read the trajectory itself, for example with h5py");
    require_frames(trajectory, chosen);
    if (trajectory.topology().mass.size() > INT32_MAX / 4)
        throw InputError("an XTC file holds at most 536 million sites", trajectory.name(),
                         "read the trajectory itself");
    if (trajectory.steps()[chosen.end(trajectory) - 1] > INT32_MAX)
        throw InputError(fmt::format("an XTC file holds steps up to {}", INT32_MAX),
                         trajectory.name(), "write the frames before with --last");
}

}  // namespace

XtcWritten write_xtc(TrajectoryFile const& trajectory, ChosenFrames const& chosen,
                     double precision) {
    refuse_unwritable(trajectory, chosen);
    std::size_t const end = chosen.end(trajectory);
    XtcWritten written{end - chosen.first, trajectory.topology().mass.size(),
                       trajectory.steps()[chosen.first], trajectory.steps()[end - 1], 0};
    AtomicFile out(chosen.file);
    Snapshot snapshot;
    for (std::size_t frame = chosen.first; frame < end; ++frame) {
        trajectory.read(frame, snapshot);
        wrap(snapshot, trajectory.topology(), chosen.wrap);
        std::string const bytes =
            frame_of(snapshot, trajectory.steps()[frame], trajectory.times()[frame],
                     {trajectory.name(), frame, precision});
        out.write(bytes);
        written.bytes += bytes.size();
    }
    out.publish();
    return written;
}

}  // namespace catena::analysis
