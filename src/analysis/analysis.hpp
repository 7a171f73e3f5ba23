// Numbers that a trajectory shows, with their errors: sizes, scaling, contacts, densities,
// diffusion.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/contacts.hpp"
#include "analysis/estimate.hpp"
#include "analysis/fits.hpp"
#include "analysis/kinds.hpp"
#include "frames/trajectory_file.hpp"

namespace catena::analysis {

struct Options {
    std::size_t first = 0, last = SIZE_MAX;  // frames from 0, both included
    double discard = 0;                      // part of the frames to leave out at the start, [0, 1)
    std::optional<double> cutoff;            // 0: no contacts; absent: 1 nm, none in SI
    std::optional<Range> fit;                // separations; absent: 6 to half the sites of a chain
    std::optional<int> slab;                 // axis 0 to 2 of the density profile
    bool find_slab = true;   // if absent: take the longest edge of a box with several
                             // chains if it is 1.5 times the others
    std::size_t bins = 200;  // number of bins of the density profile, even
};

/// A number of one kind of chains, or of the whole system.
struct Quantity {
    std::string name, kind, unit;  // kind: empty for the whole system
    Estimate value;
    /// Says what the number was computed from, or why there is none.
    std::string basis;
    /// Range and prefactor of a scaling exponent's fit R = R_0 s^nu.
    Range fit = {};
    double prefactor = NAN;
};

/// A function of one variable, of one kind of chains or of the whole system.
struct Curve {
    std::string name, kind;
    std::string variable, variable_unit, unit;
    std::vector<double> x;
    std::vector<Estimate> y;
};

/// A quantity of every copy in every frame.
struct Series {
    std::string name, kind, unit;
    CopyValues values;
};

struct Analysis {
    std::string trajectory, title, length_unit, time_unit;
    std::vector<Kind> kinds;
    std::size_t frames_in_file = 0, first_frame = 0;
    /// Steps and times of the frames that were analysed.
    std::vector<std::int64_t> steps;
    std::vector<double> times;
    std::vector<Quantity> quantities;
    std::vector<Curve> curves;
    std::vector<Series> series;
    std::vector<ContactMap> maps;
    double cutoff = 0;  // longest distance of a contact; 0: there are no maps
    std::int64_t sites_a_row = 1;
    /// Sentences that say what was assumed or left out.
    std::vector<std::string> notes;
};

/// Frames to be analysed, wherever they are.
struct FrameSource {
    std::string name;
    Topology const& topology;
    bool has_residues = true;  // false: all residues are "UNK", because no names were found
    bool by_members = false;   // true: chains of the name COMPLEX:MEMBER are members
    std::span<std::int64_t const> steps;
    std::span<double const> times;
    std::function<void(std::size_t frame, Snapshot& into)> read;
};

/// Analyses frames, one at a time. Throws InputError if no frame is left, for a
/// slab without a box and for a cutoff longer than half the box.
Analysis analyse(FrameSource const&, Options const&);
Analysis analyse(TrajectoryFile const&, Options const&);

/// Writes the tables of an analysis into an existing folder: summary.csv, one table per kind of
/// curve, and with HDF5 maps.h5, which holds contact maps and the series of every copy. Tables
/// and the picture of an earlier analysis are removed. Returns the paths.
std::vector<std::string> write_tables(Analysis const&, std::string const& folder);

/// Writes maps.h5.
void write_maps(Analysis const&, std::string const& file);

}  // namespace catena::analysis
