// Reads the frames of a trajectory and collects what they show.
#include "analysis/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "analysis/chain_numbers.hpp"
#include "analysis/density.hpp"
#include "error.hpp"
#include "frames/member_order.hpp"

namespace catena::analysis {
namespace {

constexpr double default_cutoff = 1;  // nm
constexpr double elongation = 1.5;    // least ratio of edges for a slab that is not asked for
constexpr double least_contrast = 2;  // least ratio of the densities of two phases
constexpr char const* axes[] = {"x", "y", "z"};

/// Index of the first frame to analyse.
std::size_t first_frame(FrameSource const& source, Options const& options) {
    std::size_t const frames = source.steps.size();
    auto const discarded =
        static_cast<std::size_t>(std::floor(options.discard * static_cast<double>(frames)));
    std::size_t const first = std::max(options.first, discarded);
    if (first < frames && first > options.last)
        throw InputError(
            fmt::format("the last frame, {}, is before the first, {}", options.last, first),
            "--last", "frames count from 0: choose a later one");
    if (first >= frames)
        throw InputError(
            fmt::format("there is no frame from {} on, the trajectory has {}", first, frames),
            "--first", "frames count from 0: choose fewer");
    return first;
}

/// Axis of the slab: the one asked for, or the box's longest edge if there are several chains.
std::optional<int> slab_axis(FrameSource const& source, Options const& options) {
    std::optional<Vec3> const& box = source.topology.box;
    if (options.slab && !box)
        throw InputError("a density profile needs a periodic box, and the trajectory has none",
                         std::string("--slab ") + axes[*options.slab], "leave --slab out");
    if (options.slab || !options.find_slab || !box || source.topology.chains.size() < 2)
        return options.slab;
    for (int i = 0; i < 3; ++i)
        if ((*box)[i] >= elongation * std::max((*box)[(i + 1) % 3], (*box)[(i + 2) % 3])) return i;
    return std::nullopt;
}

/// Cutoff of contacts; 0 for none.
double cutoff_of(FrameSource const& source, Options const& options) {
    return options.cutoff.value_or(source.topology.si ? 0 : default_cutoff);
}

/// Says what is no slab about the profile; empty if it may be one.
std::string doubt_of(DensityProfile const& profile) {
    if (profile.is_uneven_across())
        return "the dense part does not fill the box across the axis, as a droplet or a cylinder";
    if (profile.may_be_chance())
        return "so few chains are as uneven along the axis at random places, without two phases";
    return "";
}

/// Adds the density profiles.
void report_profiles(Analysis& to, DensityProfile const& profile, std::string const& unit) {
    for (std::size_t k = 0; k <= to.kinds.size(); ++k) {
        if (k == to.kinds.size() && k == 1) break;  // all chains are of one kind
        Curve curve{"density", k < to.kinds.size() ? to.kinds[k].name : "all",
                    "z",       to.length_unit,
                    unit,      {},
                    {}};
        for (std::size_t bin = 0; bin < profile.bins(); ++bin) {
            curve.x.push_back(profile.z(bin));
            curve.y.push_back(profile.at(k, bin));
        }
        to.curves.push_back(std::move(curve));
    }
}

/// Adds profiles and phases of a slab. `axis`: the one that was found and not asked for, or empty.
void report_slab(Analysis& to, DensityProfile const& profile, bool si, std::string const& axis) {
    std::string const unit = si ? "kg/m^3" : "mg/ml";
    report_profiles(to, profile, unit);
    Interfaces const found = profile.interfaces();
    Range const inside = DensityProfile::dense_region(found),
                outside = profile.dilute_region(found);
    std::size_t const all = to.kinds.size();
    Estimate const dense = profile.in(all, inside), dilute = profile.in(all, outside);
    if (!(dense.mean >= least_contrast * dilute.mean)) {
        to.notes.push_back(
            "no slab was found: the density profile has no dense and dilute part with room between "
            "its interfaces; see density.csv");
        return;
    }
    if (std::string const doubt = doubt_of(profile); !doubt.empty()) {
        to.notes.push_back(doubt + (axis.empty()
                                        ? ": the concentrations may not be those of two phases"
                                        : ": there are no concentrations of two phases; --slab " +
                                              axis + " gives them nevertheless"));
        if (!axis.empty()) return;
    }
    for (std::size_t k = 0; k <= all; ++k) {
        if (k == all && all == 1) break;
        std::string const kind = k < all ? to.kinds[k].name : "";
        to.quantities.push_back({"dense_concentration", kind, unit, profile.in(k, inside),
                                 fmt::format("|z| to {:.4g} {}", inside.most, to.length_unit)});
        to.quantities.push_back({"dilute_concentration", kind, unit, profile.in(k, outside),
                                 fmt::format("|z| from {:.4g} {}", outside.least, to.length_unit)});
    }
    to.quantities.push_back(
        {"slab_thickness",
         "",
         to.length_unit,
         {2 * found.position, NAN, false, NAN},
         fmt::format("between interfaces of width {:.3g} {}", found.width, to.length_unit)});
}

void report_contacts(Analysis& to, Contacts const& contacts) {
    to.maps = contacts.maps();
    to.sites_a_row = contacts.sites_a_row();
    for (std::size_t k = 0; k < to.kinds.size(); ++k) {
        ContactNumbers const& numbers = contacts.numbers()[k];
        std::string const& kind = to.kinds[k].name;
        std::string const basis = fmt::format("distance to {:g} {}", to.cutoff, to.length_unit);
        if (to.kinds[k].sites > Contacts::least_separation)
            to.quantities.push_back({"contacts_within", kind, "", numbers.within.estimate(),
                                     basis + fmt::format(", s >= {}", Contacts::least_separation)});
        bool const others = to.kinds.size() > 1 || to.kinds[k].copies_a_replica() > 1;
        if (others)
            to.quantities.push_back(
                {"contacts_between", kind, "", numbers.between.estimate(), basis + ", per chain"});
    }
    if (contacts.own_images() > 0)
        to.notes.push_back(fmt::format(
            "chains come within the cutoff of their own periodic images {} times: the box is too "
            "small for them; these pairs are not counted",
            contacts.own_images()));
    if (to.kinds.size() > Contacts::most_paired_kinds)
        to.notes.push_back(
            fmt::format("there are no contact maps between different kinds of chains: {} kinds are "
                        "more than {}",
                        to.kinds.size(), Contacts::most_paired_kinds));
    if (to.sites_a_row > 1)
        to.notes.push_back(
            fmt::format("{} consecutive sites share a row of the contact maps", to.sites_a_row));
}

/// Says which frames the displacement leaves out.
void note_uneven(Analysis& to, EvenFrames const& even) {
    if (even.between > 0)
        to.notes.push_back(fmt::format(
            "displacements leave out {} of the frames: they are not {} steps after the one before",
            even.between, even.interval));
    if (even.after > 0)
        to.notes.push_back(
            fmt::format("displacements end at step {}: the next frame is not {} steps later",
                        to.steps[even.frames.back()], even.interval));
}

/// Says how the numbers of complexes are meant.
void note_complexes(Analysis& to, Topology const& topology) {
    std::size_t complexes = 0, first = 0;
    for (std::size_t c = topology.chains.size(); c-- > 0;)
        if (is_complex(topology, c)) ++complexes, first = c;
    if (complexes > 0)
        to.notes.push_back(
            fmt::format("{} `{}` are joined by rigid bodies: numbers are those of the whole "
                        "complex, which has no ends, bonds and separations; --members takes each "
                        "member as a chain",
                        complexes == 1 ? "the members of chain" : "the members of chains such as",
                        topology.chains[first].name));
}

/// Says of cross-linked kinds which of their numbers describe open chains.
void note_crosslinks(Analysis& to, Topology const& topology) {
    for (Kind const& kind : to.kinds)
        if (!kind.is_branched() && !topology.chains[kind.chains.front()].crosslinks.empty())
            to.notes.push_back(fmt::format(
                "{} is cross-linked: internal distances and bonds follow the chain from bead to "
                "bead, and scaling exponent and persistence length are not those of an open chain",
                kind.name));
}

/// Makes errors those between replicas where these are larger, and says so.
void count_replicas(Analysis& to) {
    std::map<std::string, std::size_t> replicas;
    std::size_t most = 1;
    for (Kind const& kind : to.kinds) {
        replicas[kind.name] = kind.replicas;
        most = std::max(most, kind.replicas);
    }
    if (most == 1) return;
    for (Quantity& each : to.quantities) count_replicas(each.value, replicas[each.kind]);
    for (Curve& curve : to.curves)
        for (Estimate& each : curve.y) count_replicas(each, replicas[curve.kind]);
    to.notes.push_back(fmt::format(
        "{} replicas are independent of each other: errors are at least those between them", most));
}

Analysis frame_of(FrameSource const& source, Options const& options) {
    Analysis to;
    to.trajectory = source.name;
    to.title = source.topology.title;
    to.length_unit = source.topology.si ? "m" : "nm";
    to.time_unit = source.topology.si ? "s" : "ps";
    to.kinds = kinds_of(source.topology, source.by_members);
    to.frames_in_file = source.steps.size();
    to.first_frame = first_frame(source, options);
    auto const skipped = static_cast<std::ptrdiff_t>(to.first_frame);
    auto const end = static_cast<std::ptrdiff_t>(std::min(to.frames_in_file - 1, options.last)) + 1;
    to.steps.assign(source.steps.begin() + skipped, source.steps.begin() + end);
    to.times.assign(source.times.begin() + skipped, source.times.begin() + end);
    to.cutoff = cutoff_of(source, options);
    if (!source.has_residues)
        to.notes.emplace_back(
            "there is no topology.pdb beside the trajectory: chains with equal masses are taken as "
            "copies");
    note_complexes(to, source.topology);
    note_crosslinks(to, source.topology);
    return to;
}

}  // namespace

Analysis analyse(FrameSource const& source, Options const& options) {
    Topology const& topology = source.topology;
    Analysis to = frame_of(source, options);
    auto const frames = std::ssize(to.steps);
    std::vector<ChainNumbers> chains;
    for (Kind const& kind : to.kinds) chains.emplace_back(topology, kind, frames);
    std::optional<DensityProfile> profile;
    std::optional<int> const axis = slab_axis(source, options);
    if (axis) profile.emplace(topology, to.kinds, *axis, options.bins, frames);
    std::unique_ptr<Contacts> contacts;
    if (to.cutoff > 0) contacts = std::make_unique<Contacts>(topology, to.kinds, to.cutoff, frames);
    Snapshot snapshot;
    for (std::size_t f = 0; f < to.steps.size(); ++f) {
        source.read(to.first_frame + f, snapshot);
        for (ChainNumbers& of_kind : chains) of_kind.add(snapshot);
        if (profile) profile->add(snapshot);
        if (contacts) contacts->add(snapshot);
    }
    EvenFrames const even = even_frames(to.steps);
    for (ChainNumbers const& of_kind : chains) of_kind.report(to, options, even);
    if (contacts) report_contacts(to, *contacts);
    if (profile) report_slab(to, *profile, topology.si, options.slab ? std::string() : axes[*axis]);
    note_uneven(to, even);
    count_replicas(to);
    return to;
}

Analysis analyse(TrajectoryFile const& trajectory, Options const& options) {
    FrameSource const source{
        trajectory.name(),
        trajectory.topology(),
        trajectory.has_residues(),
        trajectory.is_by_members(),
        trajectory.steps(),
        trajectory.times(),
        [&](std::size_t frame, Snapshot& into) { trajectory.read(frame, into); }};
    return analyse(source, options);
}

}  // namespace catena::analysis
