// Implements the check for gaps between residues. Three criteria decide: the distance of the alpha
// carbons, the peptide bond if the file has its atoms, and the residue numbers. A distance that
// fits a bond of the scene's System is accepted, too.
#include "reader/gaps.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>

#include "generate/start_fit.hpp"
#include "reader/system_links.hpp"

namespace catena::scene {

namespace {

/// Smallest plausible distance of neighbours, nm. Alpha carbons of neighbours are 0.38 nm apart,
/// 0.29 nm across a cis peptide bond. Frames of models with springs in place of links (CALVADOS:
/// 8033 kJ/mol/nm2) have a spread of 0.018 nm. The distance across one missing residue is at least
/// 0.5 nm in proteins.
constexpr double least_distance = 0.25;
/// Largest distance of residues with consecutive numbers, nm: 4.5 standard deviations above 0.38
/// nm.
constexpr double largest_distance = 0.46;
/// Largest distance of residues whose numbers skip, nm.
constexpr double largest_where_numbers_skip = 0.42;
/// Distance, nm, from which on neighbours may stand at opposite sides of a box.
constexpr double least_jump = 1;
/// Largest length of a peptide bond (carbonyl carbon to the next nitrogen), nm; its usual length is
/// 0.133 nm.
constexpr double largest_peptide_bond = 0.2;

/// Distance of the nearest images, nm; the plain distance without a box.
double nearest_distance(Vec3 const& a, Vec3 const& b, std::optional<Vec3> const& box) {
    Vec3 way = b - a;
    for (int i = 0; box && i < 3; ++i) way[i] -= (*box)[i] * std::round(way[i] / (*box)[i]);
    return norm(way);
}

/// Checks pairs of neighbours and collects notes.
class Neighbours {
  public:
    /// Checks for the residues of one file; `at` is the key in messages.
    Neighbours(PdbSites const& from, ChainRequest const& request, Node const& at, GapRule rule)
        : from_(from), request_(request), at_(at), rule_(rule) {
        if (request.system)
            most_ = largest_change_of(
                request.system->largest_spread(request.particle, std::ssize(from.sites)));
    }

    /// Checks two neighbours in the chain; `b` is its bead k (from 0). Returns true if residues are
    /// missing between them and the rule accepts that.
    bool check(PdbSite const& a, PdbSite const& b, std::size_t k) {
        // Numbers may restart after 9999 in files without a fifth digit.
        std::int64_t const step = a.number && b.number ? *b.number - *a.number : 1;
        bool const wrapped =
            a.number && *a.number == 9999 && b.number && (*b.number == 0 || *b.number == 1);
        bool const falls = step < 0 && !wrapped,
                   skips = falls || (step > 1 && !follows_in_hex(a.label, b.label));
        double const apart = distance(a.alpha, b.alpha);
        double const peptide = a.carbonyl && b.nitrogen ? distance(*a.carbonyl, *b.nitrogen) : 0;
        bool const bonded = peptide <= largest_peptide_bond,
                   seen = bonded && a.carbonyl && b.nitrogen;
        bool const near = apart <= (skips && !seen ? largest_where_numbers_skip : largest_distance);
        // Fusion proteins keep the numbers of their parts. There the peptide bond proves that the
        // residues are neighbours.
        if (falls && !(seen && near)) refuse_order(a, b);
        if ((near && bonded && apart >= least_distance) || fits_system(k, apart)) {
            count(a, b, skips);
            return false;
        }
        bool const gap = apart >= least_distance && !is_wrapped(a, b);
        if (rule_ != GapRule::refuse && gap) return true;
        if (rule_ != GapRule::refuse || !request_.links_as_given())
            refuse(a, b, apart, near && !bonded ? peptide : 0, skips);
        if (gaps_++ == 0) first_gap_ = fmt::format("{} and {}, {:.3f} nm", a.label, b.label, apart);
        return false;
    }
    /// Notes the skips and gaps that were accepted.
    void note() const {
        if (skips_ > 0)
            request_.scene.note(
                fmt::format("`{}`: residue numbers skip {} between neighbours at a link's distance "
                            "(first: {}): no residue "
                            "is missing there",
                            from_.file, times(skips_), first_skip_));
        if (gaps_ > 0)
            request_.scene.note(fmt::format(
                "`{}`: `links: as_given` keeps {} that neighbours cannot have (first: {})",
                from_.file, gaps_ == 1 ? "1 distance" : fmt::format("{} distances", gaps_),
                first_gap_));
    }

  private:
    /// True if OpenMM's numbers follow each other: it continues after 9999 with A000 in base 16,
    /// whereas hybrid-36 has base 36.
    static bool follows_in_hex(std::string const& a, std::string const& b) {
        unsigned from = 0, to = 0;
        auto const read = [](std::string const& text, unsigned& value) {
            return std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
                   std::from_chars(text.data(), text.data() + text.size(), value, 16).ptr ==
                       text.data() + text.size();
        };
        return !a.empty() && !b.empty() && read(a, from) && read(b, to) && to == from + 1;
    }
    /// True if the distance fits the System's bond between the two beads, which is more specific
    /// than the residues.
    bool fits_system(std::size_t k, double apart) const {
        if (!request_.system) return false;
        double const length =
            request_.system->length(request_.particle + static_cast<std::int64_t>(k));
        if (apart > length)
            return apart - length <=
                   (request_.scene.relax ? largest_relaxed_change : most_) * length;
        return apart <= length &&
               (request_.scene.relax ||
                length - apart <= most_ * length);  // false for NaN: nothing joins the beads
    }
    static std::string times(int n) { return n == 1 ? "once" : fmt::format("{} times", n); }

    /// Counts a pair whose numbers skip.
    void count(PdbSite const& a, PdbSite const& b, bool skips) {
        if (skips && skips_++ == 0) first_skip_ = fmt::format("{} to {}", a.label, b.label);
    }
    /// Distance, nm, of the nearest images if the scene has a box.
    double distance(Vec3 const& a, Vec3 const& b) const {
        return nearest_distance(a, b, request_.scene.box);
    }
    /// True if the gap vanishes in the file's own cell, which the scene does not give as its box.
    bool is_wrapped(PdbSite const& a, PdbSite const& b) const {
        return from_.cell && !request_.scene.box &&
               nearest_distance(a.alpha, b.alpha, from_.cell) <= largest_distance;
    }
    /// Throws InputError for residues whose numbers decrease.
    [[noreturn]] void refuse_order(PdbSite const& a, PdbSite const& b) const {
        fail(at_,
             fmt::format("residue {} {} follows {} {} in `{}`", b.residue, b.label, a.residue,
                         a.label, from_.file),
             "sort the residues by their numbers, number them along the chain, or keep one chain "
             "per file");
    }
    /// Throws InputError with the most likely reason: too close, wrapped into the file's cell, or a
    /// gap. `peptide` is the length of a broken peptide bond, nm, or 0; `skips` says that the
    /// residue numbers do not follow each other.
    [[noreturn]] void refuse(PdbSite const& a, PdbSite const& b, double apart, double peptide,
                             bool skips) const {
        std::string const pair = fmt::format("residues {} {} and {} {} of `{}`", a.residue, a.label,
                                             b.residue, b.label, from_.file);
        if (apart < least_distance)
            fail(at_,
                 fmt::format("{} stand {:.3f} nm apart, nearer than neighbours can", pair, apart),
                 "correct the file (its unit is angstrom), or write `links: as_given`");
        std::string const broken =
            peptide > 0 ? fmt::format(", the peptide bond between them is {:.3f} nm long", peptide)
                        : "";
        if (is_wrapped(a, b))
            fail(at_,
                 fmt::format("{} stand {:.3f} nm apart: the file is wrapped into its cell (CRYST1)",
                             pair, apart),
                 fmt::format(
                     "write `box: {{periodic: [{:.6g}, {:.6g}, {:.6g}]}}`, or make the chain whole",
                     (*from_.cell)[0], (*from_.cell)[1], (*from_.cell)[2]));
        bool const may_be_wrapped = !skips && !request_.scene.box && apart > least_jump;
        fail(at_,
             fmt::format("{} stand {:.3f} nm apart{}: the chain has a gap", pair, apart, broken),
             std::string(
                 "write `gaps: split` for two chains, `gaps: model` to grow what is missing, "
                 "or `links: as_given` to keep the distance") +
                 (may_be_wrapped ? " (if the chain is wrapped into a box, give `box`)" : ""));
    }

    PdbSites const& from_;
    ChainRequest const& request_;
    Node const& at_;
    GapRule rule_;
    /// Largest relative change of a link of the System.
    double most_ = 0;
    /// Numbers of accepted skips and gaps, and the first of each.
    int skips_ = 0, gaps_ = 0;
    std::string first_skip_, first_gap_;
};

}  // namespace

std::vector<std::size_t> find_gaps(PdbSites const& from, ChainRequest const& request,
                                   Node const& at, GapRule rule) {
    Neighbours neighbours(from, request, at, rule);
    std::vector<std::size_t> gaps;
    for (std::size_t k = 1; k < from.sites.size(); ++k)
        if (neighbours.check(from.sites[k - 1], from.sites[k], k)) gaps.push_back(k);
    neighbours.note();
    return gaps;
}

}  // namespace catena::scene
