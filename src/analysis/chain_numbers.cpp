// Implements the numbers of one kind of chains.
#include "analysis/chain_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/displacement.hpp"
#include "frames/member_order.hpp"

namespace catena::analysis {
namespace {

constexpr std::size_t histogram_bins = 40;
constexpr double least_fitted = 6;  // separation; closer sites show the chain's local structure

/// Spread of the radius of gyration, relative to its mean, below which a chain counts as folded: a
/// flexible one has about 0.2. Rods, whose radius hardly varies either, are more aspherical.
constexpr double of_folded = 0.05, least_rod = 0.5;
constexpr std::int64_t least_sites = 10;  // of a chain that can fold

/// Separations of the fit unless the user names others. Beyond half of the chain few pairs are
/// left, and its ends weigh.
Range default_fit(Kind const& kind) {
    return {least_fitted, static_cast<double>(kind.sites / (kind.ring ? 4 : 2))};
}

/// Estimates of the probability density of values in equal bins from `least` to `most`.
std::vector<Estimate> histogram(CopyValues const& values, double least, double most) {
    double const width = (most - least) / static_cast<double>(histogram_bins);
    std::vector<CopyValues> inside(histogram_bins, CopyValues(values.copies()));
    for (double const value : values.values()) {
        auto const bin =
            std::min(histogram_bins - 1, static_cast<std::size_t>((value - least) / width));
        for (std::size_t b = 0; b < histogram_bins; ++b) inside[b].add(b == bin ? 1 / width : 0);
    }
    std::vector<Estimate> densities;
    for (CopyValues const& of_bin : inside) densities.push_back(of_bin.estimate());
    return densities;
}

}  // namespace

ChainNumbers::ChainNumbers(Topology const& topology, Kind const& kind, std::int64_t frames)
    : topology_(topology),
      kind_(kind),
      is_complex_(is_complex(topology, kind.chains.front())),
      radius_(kind.copies(), kind.together()),
      end_to_end_(kind.copies(), kind.together()),
      asphericity_(kind.copies(), kind.together()),
      internal_(kind, frames) {}

void ChainNumbers::add(Snapshot const& snapshot) {
    for (std::size_t c = 0; c < kind_.copies(); ++c) {
        auto const first = static_cast<std::size_t>(topology_.chains[kind_.chains[c]].first);
        auto const count = static_cast<std::size_t>(kind_.sites);
        auto const x = std::span(snapshot.position).subspan(first, count);
        Gyration const gyration = gyration_of(x, std::span(topology_.mass).subspan(first, count));
        radius_.add(gyration.radius());
        asphericity_.add(gyration.asphericity());
        end_to_end_.add(norm(x.back() - x.front()));
        centres_.push_back(gyration.centre);
        if (!kind_.is_branched()) internal_.add(c, x);
    }
    internal_.end_frame();
}

void ChainNumbers::report(Analysis& to, Options const& options, EvenFrames const& even) const {
    if (kind_.sites > 1) {
        report_sizes(to);
        report_distribution(to);
    }
    if (kind_.is_branched())
        to.notes.push_back(fmt::format(
            "{} is branched: its end-to-end distance, internal distances, scaling exponent, bond "
            "correlation and persistence length are left out",
            kind_.name));
    if (kind_.sites > 1 && !is_complex_ && !kind_.is_branched()) {
        report_distances(to, options);
        report_bonds(to);
        note_folded(to);
    }
    report_displacement(to, even);
}

void ChainNumbers::report_sizes(Analysis& to) const {
    std::string const& unit = to.length_unit;
    to.quantities.push_back(
        {"radius_of_gyration", kind_.name, unit, radius_.estimate(), "weighted by mass"});
    to.series.push_back({"radius_of_gyration", kind_.name, unit, radius_});
    if (!kind_.ring && !is_complex_ && !kind_.is_branched()) {
        to.quantities.push_back({"end_to_end_distance", kind_.name, unit, end_to_end_.estimate(),
                                 "first to last site"});
        to.series.push_back({"end_to_end_distance", kind_.name, unit, end_to_end_});
    }
    to.quantities.push_back({"asphericity", kind_.name, "", asphericity_.estimate(),
                             "0 sphere, 1 rod, weighted by mass"});
    to.series.push_back({"asphericity", kind_.name, "", asphericity_});
}

void ChainNumbers::note_folded(Analysis& to) const {
    double const mean = radius_.estimate().mean;
    double squares = 0;
    for (double const value : radius_.values()) squares += (value - mean) * (value - mean);
    double const varies = std::sqrt(squares / static_cast<double>(radius_.values().size())) / mean;
    bool const is_rod = asphericity_.estimate().mean > least_rod;
    if (kind_.sites < least_sites || is_rod || !(varies < of_folded)) return;
    to.notes.push_back(fmt::format(
        "the radius of gyration of {} varies by {:.2g} % only, as in a folded chain or a short "
        "run: its scaling exponent and persistence length do not describe a flexible chain",
        kind_.name, 100 * varies));
}

void ChainNumbers::report_distribution(Analysis& to) const {
    auto const [least, most] =
        std::minmax_element(radius_.values().begin(), radius_.values().end());
    if (!(*most > *least)) return;
    Curve curve{"radius_distribution",
                kind_.name,
                "radius_of_gyration",
                to.length_unit,
                "1/" + to.length_unit,
                {},
                histogram(radius_, *least, *most)};
    for (std::size_t b = 0; b < histogram_bins; ++b)
        curve.x.push_back(*least + (*most - *least) * (static_cast<double>(b) + 0.5) /
                                       static_cast<double>(histogram_bins));
    to.curves.push_back(std::move(curve));
}

void ChainNumbers::report_distances(Analysis& to, Options const& options) const {
    CurveMeans const& squares = internal_.squared_distances();
    Curve curve{"internal_distances", kind_.name, "separation", "sites", to.length_unit, {}, {}};
    for (std::size_t k = 0; k < internal_.separations().size(); ++k) {
        Estimate const square = squares.at(k);
        double const root = std::sqrt(square.mean);
        curve.x.push_back(static_cast<double>(internal_.separations()[k]));
        curve.y.push_back(
            {root, square.error / (2 * root), square.plateau, square.between / (2 * root)});
    }
    to.curves.push_back(std::move(curve));
    Scaling const scaling =
        fit_scaling(internal_.separations(), squares, options.fit.value_or(default_fit(kind_)));
    Fitted const& nu = scaling.exponent;
    to.quantities.push_back(
        {"scaling_exponent", kind_.name, "", nu.value,
         nu.why.empty() ? fmt::format("R = {:.4g} {} s^nu, fit s = {:g} to {:g}", scaling.prefactor,
                                      to.length_unit, nu.range.least, nu.range.most)
                        : nu.why + ", choose --fit MIN,MAX",
         nu.range, scaling.prefactor});
}

void ChainNumbers::report_bonds(Analysis& to) const {
    Estimate const length = internal_.bond_length().at(0);
    to.quantities.push_back({"bond_length", kind_.name, to.length_unit, length, ""});
    Curve curve{"bond_correlation", kind_.name, "separation", "bonds", "", {}, {}};
    for (std::size_t k = 0; k < internal_.bond_separations().size(); ++k) {
        curve.x.push_back(static_cast<double>(internal_.bond_separations()[k]));
        curve.y.push_back(internal_.cosines().at(k));
    }
    to.curves.push_back(std::move(curve));
    Fitted const fitted =
        fit_persistence(internal_.bond_separations(), internal_.cosines(), length.mean);
    to.quantities.push_back({"persistence_length", kind_.name, to.length_unit, fitted.value,
                             fitted.why.empty()
                                 ? fmt::format("cosine = exp(-s b / l), fit s = {:g} to {:g}",
                                               fitted.range.least, fitted.range.most)
                                 : fitted.why});
}

void ChainNumbers::report_displacement(Analysis& to, EvenFrames const& even) const {
    std::vector<Vec3> centres;
    for (std::size_t const frame : even.frames) {
        auto const begin = centres_.begin() + static_cast<std::ptrdiff_t>(frame * kind_.copies());
        centres.insert(centres.end(), begin, begin + static_cast<std::ptrdiff_t>(kind_.copies()));
    }
    double const interval = to.times.size() > 1 ? to.times[1] - to.times[0] : 0;
    Displacements const found = displacements_of(centres, kind_.copies(), interval);
    std::string const square = to.length_unit + "^2";
    if (!found.lag.empty())
        to.curves.push_back(
            {"displacement", kind_.name, "lag", to.time_unit, square, found.lag, found.square});
    Fitted const& d = found.diffusion;
    to.quantities.push_back({"diffusion", kind_.name, square + "/" + to.time_unit, d.value,
                             d.why.empty()
                                 ? fmt::format("centre of mass, fit lag = {:.4g} to {:.4g} {}",
                                               d.range.least, d.range.most, to.time_unit)
                                 : d.why});
}

}  // namespace catena::analysis
