// Implements the fit of start positions: nearest images, projection of links and notes.
#include "generate/start_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "generate/cells.hpp"
#include "generate/crosslinks.hpp"
#include "generate/link_projection.hpp"
#include "generate/nearest.hpp"
#include "scene/force_changes.hpp"

namespace catena::scene {

namespace {

/// Beginning and end of the two notes.
std::string_view constexpr moved_note =
    "the start's positions were moved so that links have their lengths",
                           whole_note = ": made whole by nearest images";
/// Relative change of a link below which it is rounding.
double constexpr rounding = 1e-9;
/// Relative difference of distances below which pairs count as equally near.
double constexpr as_near = 0.01;
/// Relative difference from 10 or 1/10 of most distances, in links, up to which they are taken for
/// those in another unit, and the least number of links that tells.
double constexpr of_ten = 0.1;
std::size_t constexpr least_ratios = 3;
/// Distance in links below which beads that are not neighbours overlap.
double constexpr overlap = 0.66;

/// Inboard end of link k (from 0): the bead on which bead k hangs, or the anchor.
Vec3 inboard_end(StartFit::Chain const& chain, std::size_t k) {
    return k == 0 ? chain.beads.anchor : chain.beads.position[inboard_of(chain.parents, k)];
}
std::size_t first_link(Base base) { return base == Base::fixed ? 0 : 1; }

std::vector<double> distances_of(StartFit::Chain const& chain) {
    std::vector<double> distances(chain.beads.size(), 0.0);
    for (std::size_t k = first_link(chain.base); k < chain.beads.size(); ++k)
        distances[k] = norm(chain.beads.position[k] - inboard_end(chain, k));
    return distances;
}

/// Names the two ends of link k, which may be the tip's: its index is the number of beads.
std::string ends_of(StartFit::Chain const& chain, std::size_t k) {
    if (k == 0) return "the anchor and bead 1";
    if (k < chain.beads.size())
        return fmt::format("beads {} and {}", inboard_of(chain.parents, k) + 1, k + 1);
    return chain.tip->ring ? fmt::format("beads {} and 1", k)
                           : fmt::format("bead {} and the tip's anchor", k);
}

/// Longest link within half of every edge of the box.
double longest_uncut(StartFit::Chain const& chain, Vec3 const& edge) {
    double longest = 0;
    for (std::size_t k = first_link(chain.base); k < chain.beads.size(); ++k) {
        Vec3 const link = chain.beads.position[k] - inboard_end(chain, k);
        bool cut = false;
        for (int i = 0; i < 3; ++i) cut = cut || std::abs(link[i]) > 0.5 * edge[i];
        if (!cut) longest = std::max(longest, norm(link));
    }
    return longest;
}

/// Beads and domains of a chain as units of LinkProjection. The anchor of a fixed base comes first
/// and is held.
class Units {
  public:
    explicit Units(StartFit::Chain const& chain) : chain_(chain) {
        BeadArrays const& beads = chain.beads;
        if (chain.base == Base::fixed) add(beads.anchor, Vec3::zero(), 0, 0);
        auto domain = chain.rigid.begin();
        for (std::size_t k = 0; k < beads.size(); ++k) {
            std::size_t last = k;
            if (domain != chain.rigid.end() && domain->first == k) last = (domain++)->last;
            add(beads.position[k], beads.position[last] - beads.position[k], beads.length[k],
                1 / static_cast<double>(last - k + 1));
            first_.push_back(k);
            k = last;
        }
        if (chain.tip && !chain.tip->ring)
            add(*chain.tip->anchor, Vec3::zero(), chain.tip->length, 0);
        parent_ = unit_parents(chain.parents, chain.base);
        given_ = at_;
    }

    /// Projects the links; returns true if they have their lengths. The beads move with their
    /// units.
    bool project() {
        double const closing = chain_.tip && chain_.tip->ring ? chain_.tip->length : 0;
        bool const closed = LinkProjection().project(
            {at_, length_, mobility_, inboard_, outboard_, closing, parent_});
        std::size_t const anchors = chain_.base == Base::fixed ? 1 : 0;
        for (std::size_t u = 0; u < first_.size(); ++u) {
            Vec3 const shift = at_[u + anchors] - given_[u + anchors];
            std::size_t const end = u + 1 < first_.size() ? first_[u + 1] : chain_.beads.size();
            chain_.beads.position[first_[u]] = at_[u + anchors];
            for (std::size_t k = first_[u] + 1; k < end; ++k)
                chain_.beads.position[k] = chain_.beads.position[k] + shift;
        }
        return closed;
    }

  private:
    void add(Vec3 const& at, Vec3 const& outboard, double length, double mobility) {
        at_.push_back(at), outboard_.push_back(outboard), inboard_.push_back(Vec3::zero());
        length_.push_back(length), mobility_.push_back(mobility);
    }

    StartFit::Chain const& chain_;
    std::vector<Vec3> at_, given_, inboard_, outboard_;
    std::vector<double> length_, mobility_;
    std::vector<std::size_t> first_;    // first bead of each unit
    std::vector<std::int64_t> parent_;  // as LinkedUnits::parent
};

}  // namespace

void forget_fits(Scene& scene) {
    scene.start = {};
    std::erase_if(scene.notes, [](std::string const& note) {
        return note.starts_with(moved_note) || note.ends_with(whole_note) ||
               note.ends_with(closing_note) || note.ends_with(special_note);
    });
}

void StartFit::make_whole(Chain const& chain, bool as_given, std::optional<Vec3> const& box) {
    if (!box) return;
    Images const images(*box);
    double const usual = as_given ? longest_uncut(chain, images.edge()) : 0;
    std::vector<Vec3>& position = chain.beads.position;
    std::vector<Vec3> const given = position;
    std::vector<Vec3> shifts(position.size(), Vec3::zero());
    std::int64_t cut = 0;
    for (std::size_t k = first_link(chain.base); k < chain.beads.size(); ++k) {
        std::size_t const inboard = k == 0 ? 0 : inboard_of(chain.parents, k);
        Vec3 const link = given[k] - (k == 0 ? chain.beads.anchor : given[inboard]),
                   image = images.shortest(link);
        Vec3& shift = shifts[k] = k == 0 ? Vec3::zero() : shifts[inboard];
        bool const is_cut = as_given ? norm(image) < norm(link) && norm(image) <= most_usual * usual
                                     : std::abs(norm(image) - chain.beads.length[k]) <
                                           std::abs(norm(link) - chain.beads.length[k]);
        if (is_cut) {
            shift = shift - images.whole_edges(link);
            if (cut_links_ + cut == 0)
                first_cut_ = fmt::format("{} of chain `{}`", ends_of(chain, k), shown(chain.name));
            ++cut;
        }
        for (int i = 0; i < 3; ++i)
            if (shift[i] != 0) position[k][i] += shift[i];
    }
    cut_links_ += cut;
    if (cut > 0) ++cut_chains_;
}

void StartFit::fit(Chain const& chain) {
    std::vector<double> const before = distances_of(chain);
    Change const worst = largest_change(chain, before);
    refuse_unit(chain, before);
    refuse(chain, worst, before);
    project(chain, worst);
}

void StartFit::close(Chain const& chain, double distance) {
    double const length = chain.tip->length;
    project(chain, {std::abs(distance - length) / length, distance, length, chain.beads.size()});
}

void StartFit::project(Chain const& chain, Change const& worst) {
    std::vector<Vec3> const given = chain.beads.position;
    bool closed = Units(chain).project();
    for (std::size_t k = 1; k < given.size(); ++k)
        closed = closed && dot(given[k] - given[inboard_of(chain.parents, k)],
                               chain.beads.position[k] - inboard_end(chain, k)) > 0;
    if (!closed)
        fail(from_,
             fmt::format("no small change of positions gives the links of chain `{}` their lengths",
                         shown(chain.name)),
             remedy_);
    record(chain, worst, given);
}

StartFit::Change StartFit::largest_change(Chain const& chain,
                                          std::vector<double> const& before) const {
    Change worst;
    for (std::size_t k = first_link(chain.base); k < before.size(); ++k) {
        double const length = chain.beads.length[k], part = std::abs(before[k] - length) / length;
        if (!(part <= worst.part)) worst = {part, before[k], length, k};
    }
    return worst;
}

void StartFit::refuse_unit(Chain const& chain, std::vector<double> const& before) const {
    std::vector<double> ratios;
    for (std::size_t k = first_link(chain.base); k < before.size(); ++k)
        ratios.push_back(before[k] / chain.beads.length[k]);
    if (scene_.si || ratios.size() < least_ratios) return;
    auto const middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    bool const large = std::abs(*middle / 10 - 1) < of_ten,
               small = std::abs(10 * *middle - 1) < of_ten;
    if (!large && !small) return;
    bool const named = scene_.forces.openmm && !changes_of(*scene_.forces.openmm).links.empty();
    fail(from_,
         fmt::format("neighbours in chain `{}` are {:.3g} times as far apart as their links are "
                     "long: the positions {}seem to be in another unit",
                     shown(chain.name), *middle, named ? "or the lengths of `links` " : ""),
         fmt::format("{}multiply the positions by {}: PDB and mmCIF files hold angstrom, tables "
                     "and OpenMM's States nm",
                     named ? "correct these lengths, nm, or " : "", large ? "0.1" : "10"));
}

void StartFit::refuse(Chain const& chain, Change const& worst,
                      std::vector<double> const& before) const {
    auto const too_much = [&](double from, double to) {
        return from > to ? from - to > most_shortened() * to
                         : !scene_.relax && to - from > most_ * to;
    };
    Change named = worst;
    std::size_t links = 0;
    for (std::size_t k = first_link(chain.base); k < before.size(); ++k) {
        double const length = chain.beads.length[k];
        if (!too_much(before[k], length)) continue;
        double const part = std::abs(before[k] - length) / length;
        if (links++ == 0 || part > named.part) named = {part, before[k], length, k};
    }
    if (links == 0) return;
    std::string what = fmt::format(
        "{} of chain `{}` are {:.4g} {} apart, their link is {:.4g} {} long",
        ends_of(chain, named.link), shown(chain.name), named.from, unit(), named.to, unit());
    if (links > 1)
        what += fmt::format(", and {} would change by more than {:.0f} %",
                            links == 2 ? "another link" : fmt::format("{} other links", links - 1),
                            100 * most_shortened());
    what += nearest_text(chain);
    std::string remedy = remedy_;
    bool const mended = named.from < named.to || named.from - named.to <= relaxed_ * named.to;
    if (mended && !scene_.relax) remedy += ", or `relax: true`";
    if (named.from > named.to && !scene_.box)
        remedy += " (if the chain is wrapped into a box, give `box`)";
    fail_at(from_, "bead", static_cast<std::int64_t>(named.link) + 1, what, remedy);
}

/// Describes an overlap in addition to the error found; empty if there is none.
std::string StartFit::nearest_text(Chain const& chain) const {
    double const within =
        overlap * *std::max_element(chain.beads.length.begin(), chain.beads.length.end());
    std::vector<Vec3> const& position = chain.beads.position;
    // The distance of second neighbours bounds the search, whose time grows with the number of
    // pairs. In a table in another unit all beads lie within one link.
    double bound = within;
    std::size_t nearest = 0, second = 0;
    for (std::size_t k = 2; k < position.size(); ++k) {
        std::size_t const inboard = inboard_of(chain.parents, k);
        if (inboard == 0) continue;
        std::size_t const other = inboard_of(chain.parents, inboard);
        if (double const apart = norm(position[k] - position[other]); apart < bound)
            bound = apart, nearest = k, second = other;
    }
    if (nearest > 0 && bound <= rounding * within)
        return fmt::format("; beads {} and {} overlap: {:.3g} {} apart", second + 1, nearest + 1,
                           bound, unit());
    auto const counts = [&](std::size_t i, std::size_t j) {
        return i < j && inboard_of(chain.parents, j) != i;
    };
    std::optional<NearPair> const near =
        nearest_pair(position, scene_.box, bound * (1 + rounding), counts);
    if (!near) return "";
    // Many pairs may be equally near, as in a hairpin. The overlap of those in its middle is more
    // typical than that at its ends.
    std::vector<NearPair> pairs;
    for_each_near_pair(position, scene_.box,
                       std::max(near->distance * (1 + as_near), rounding * within),
                       [&](std::size_t i, std::size_t j, Vec3 const& apart) {
                           if (counts(i, j)) pairs.push_back({i, j, norm(apart)});
                       });
    NearPair const& worst = pairs[pairs.size() / 2];
    std::string const others =
        pairs.size() < 2 ? "" : fmt::format(", and {} more such pairs", pairs.size() - 1);
    return fmt::format("; beads {} and {} overlap: {:.3g} {} apart{}", worst.first + 1,
                       worst.second + 1, worst.distance, unit(), others);
}

void StartFit::record(Chain const& chain, Change const& worst, std::vector<Vec3> const& given) {
    StartChange& start = scene_.start;
    auto const links = std::max_element(chain.beads.length.begin(), chain.beads.length.end());
    std::size_t furthest = 0;
    double moved = 0;
    for (std::size_t k = 0; k < given.size(); ++k)
        if (double const way = norm(chain.beads.position[k] - given[k]); way > moved)
            moved = way, furthest = k;
    if (worst.part > rounding) {
        std::string const text =
            fmt::format("chain `{}`, {}: {:.6g} to {:.6g} {}", shown(chain.name),
                        ends_of(chain, worst.link), worst.from, worst.to, unit());
        if (double const change = std::abs(worst.from - worst.to); change > start.link)
            start.link = change, start.link_at = text;
        if (worst.part > largest_) largest_ = worst.part, link_ = text;
    }
    if (moved > rounding * *links) {
        std::string const text =
            fmt::format("chain `{}`, bead {}", shown(chain.name), furthest + 1);
        if (moved >= *links) moved_far_ = true;
        if (moved > start.position) start.position = moved, start.moved_at = text;
        if (moved > most_moved_) most_moved_ = moved, moved_ = text;
    }
}

void StartFit::note() const {
    if (cut_links_ > 0) {
        std::string const links = cut_links_ == 1 ? "1 link" : fmt::format("{} links", cut_links_);
        std::string const chains =
            cut_chains_ == 1 ? "1 chain" : fmt::format("{} chains", cut_chains_);
        scene_.note(
            fmt::format("{} of {} {} cut by the sides of the periodic box, the first between {}{}",
                        links, chains, cut_links_ == 1 ? "is" : "are", first_cut_, whole_note));
    }
    if (largest_ >= noted_link_change || moved_far_)
        scene_.note(
            fmt::format("{}: the largest change of a link is {:.2g} % "
                        "({}), the largest displacement of a bead {:.3g} {} ({})",
                        moved_note, 100 * largest_, link_, most_moved_, unit(), moved_));
}

}  // namespace catena::scene
