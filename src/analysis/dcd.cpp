// Implements the DCD format: Fortran records, each between two copies of its length in bytes.
// Layout: https://www.ks.uiuc.edu/Research/vmd/plugins/molfile/dcdplugin.html
#include "analysis/dcd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "analysis/even_frames.hpp"
#include "error.hpp"
#include "io/output_file.hpp"

namespace catena::analysis {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written as they lie");

constexpr double angstrom_per_nm = 10;
constexpr double ps_per_akma = 4.888821e-2;  // time unit of the format, as its readers take it
constexpr std::int64_t most_steps = INT32_MAX;
constexpr std::int32_t charmm_version = 24;

template <class Value>
void append(std::string& bytes, Value const& value) {
    bytes.append(reinterpret_cast<char const*>(&value), sizeof value);
}

void write_record(AtomicFile& out, std::string const& bytes) {
    std::string record;
    auto const length = static_cast<std::int32_t>(bytes.size());
    append(record, length);
    record += bytes;
    append(record, length);
    out.write(record);
}

std::string padded(std::string text) {
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    text.resize(80, ' ');
    return text;
}

void write_header(AtomicFile& out, DcdWritten const& written, bool periodic,
                  std::string const& title) {
    std::array<std::int32_t, 20> control{};
    control[0] = static_cast<std::int32_t>(written.frames);
    control[1] = static_cast<std::int32_t>(written.first_step);
    control[2] = static_cast<std::int32_t>(std::max<std::int64_t>(1, written.interval));
    control[3] =
        static_cast<std::int32_t>(static_cast<std::int64_t>(written.frames) * written.interval);
    control[9] = std::bit_cast<std::int32_t>(static_cast<float>(written.time_step / ps_per_akma));
    control[10] = periodic ? 1 : 0;
    control[19] = charmm_version;
    std::string head = "CORD";
    append(head, control);
    write_record(out, head);
    std::string titles;
    append(titles, std::int32_t{2});
    titles += padded(title) + padded("REMARKS WRITTEN BY CATENA");
    write_record(out, titles);
    std::string sites;
    append(sites, static_cast<std::int32_t>(written.sites));
    write_record(out, sites);
}

void write_frame(AtomicFile& out, Snapshot const& snapshot) {
    if (snapshot.box) {
        Vec3 const edge = angstrom_per_nm * *snapshot.box;
        std::string cell;
        for (double const value : {edge[0], 90.0, edge[1], 90.0, 90.0, edge[2]})
            append(cell, value);
        write_record(out, cell);
    }
    for (int i = 0; i < 3; ++i) {
        std::string coordinates;
        for (Vec3 const& x : snapshot.position)
            append(coordinates, static_cast<float>(angstrom_per_nm * x[i]));
        write_record(out, coordinates);
    }
}

/// Refuses what the format cannot hold.
void require_writable(TrajectoryFile const& trajectory, ChosenFrames const& chosen) {
    if (trajectory.topology().si)
        throw InputError("a DCD file holds Angstrom, and the trajectory is in m", trajectory.name(),
                         "read the trajectory itself, for example with h5py");
    require_frames(trajectory, chosen);
    if (trajectory.topology().mass.size() > INT32_MAX / sizeof(float))
        throw InputError("a DCD file holds at most 536 million sites", trajectory.name(),
                         "read the trajectory itself");
}

}  // namespace

DcdWritten write_dcd(TrajectoryFile const& trajectory, ChosenFrames const& chosen) {
    require_writable(trajectory, chosen);
    std::size_t const end = chosen.end(trajectory);
    auto const steps = std::span(trajectory.steps()).subspan(chosen.first, end - chosen.first);
    EvenFrames const even = even_frames(steps);
    if (even.after > 0)
        throw InputError(
            fmt::format(
                "frames are not evenly spaced: after step {} there is none {} steps on, and "
                "a DCD file holds one interval",
                steps[even.frames.back()], even.interval),
            trajectory.name(), "write parts, with --first and --last");
    if (steps.back() > most_steps || even.interval > most_steps)
        throw InputError(fmt::format("a DCD file holds steps up to {}", most_steps),
                         trajectory.name(), "write the frames before with --last");
    DcdWritten written{
        even.frames.size(), trajectory.topology().mass.size(), steps.front(), even.interval, 0,
        even.between};
    std::vector<double> const& times = trajectory.times();
    if (even.interval > 0)
        written.time_step =
            (times[chosen.first + 1] - times[chosen.first]) / static_cast<double>(even.interval);
    else if (steps.front() > 0)
        written.time_step = times[chosen.first] / static_cast<double>(steps.front());
    AtomicFile out(chosen.file);
    write_header(out, written, trajectory.topology().box.has_value(), trajectory.topology().title);
    Snapshot snapshot;
    for (std::size_t const frame : even.frames) {
        trajectory.read(chosen.first + frame, snapshot);
        wrap(snapshot, trajectory.topology(), chosen.wrap);
        write_frame(out, snapshot);
    }
    out.publish();
    return written;
}

}  // namespace catena::analysis
