// Implements the modelling of missing residues. Their names come from the chain's sequence: by the
// residues' positions in it (mmCIF), or by the only place where all known residues fit (PDB).
#include "reader/missing_residues.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <string>

#include "generate/conformation.hpp"
#include "generate/linker.hpp"
#include "reader/sequences.hpp"
#include "structure/residue_names.hpp"

namespace catena::scene {

namespace {

using ResidueNames = std::vector<std::string>;

/// Length of a linker's links, nm: the distance of neighbouring alpha carbons. The start is fitted
/// to the model's own lengths afterwards.
constexpr double grown_link = 0.38;

/// True if both names mean one residue; force fields rename some.
bool same_residue(std::string const& a, std::string const& b) {
    return a == b ||
           (!meaning_of(a).parent.empty() && meaning_of(a).parent == meaning_of(b).parent);
}

std::string joined_names(ResidueNames const& names) {
    std::string text;
    for (std::string const& name : names) text += (text.empty() ? "" : " ") + shown(name);
    return text;
}

/// One gap of a chain.
struct Gap {
    std::size_t site = 0;  // first site behind the gap
    ResidueNames missing;
};

/// Finds the names of the missing residues.
class SequenceSearch {
  public:
    SequenceSearch(PdbSites const& from, std::vector<std::size_t> const& gaps, Node const& at)
        : from_(from), gaps_(gaps), at_(at), listed_(from.chains.at(0).sequence.names) {
        if (listed_.empty())
            refuse(gaps.front(), "the file lists no sequence of the chain",
                   "add its SEQRES records or `_entity_poly_seq`, or write `gaps: split`");
    }

    /// Returns the gaps with what is missing in each.
    std::vector<Gap> missing() const {
        bool const indexed =
            std::all_of(from_.sites.begin(), from_.sites.end(),
                        [](PdbSite const& site) { return site.sequence_index.has_value(); });
        return indexed ? by_index() : by_search();
    }

    /// Throws InputError for the gap before the site k.
    [[noreturn]] void refuse(std::size_t k, std::string const& why,
                             std::string const& remedy) const {
        fail(at_,
             fmt::format("the gap between residues {} {} and {} {} of `{}` cannot be modelled: {}",
                         from_.sites[k - 1].residue, from_.sites[k - 1].label,
                         from_.sites[k].residue, from_.sites[k].label, from_.file, why),
             remedy);
    }

  private:
    std::vector<Gap> by_index() const {
        std::vector<Gap> found;
        for (std::size_t const k : gaps_)
            found.push_back(
                between(k, *from_.sites[k - 1].sequence_index, *from_.sites[k].sequence_index - 1));
        return found;
    }
    /// The residues [first, last) of the sequence, which are missing before the site k.
    Gap between(std::size_t k, std::int64_t first, std::int64_t last) const {
        bool const inside = first >= 0 && first < last && last <= std::ssize(listed_);
        if (!inside)
            refuse(k, "no residue of the sequence is missing there",
                   "correct the file, or write `gaps: split`");
        Gap gap{k, ResidueNames(listed_.begin() + first, listed_.begin() + last)};
        if (std::any_of(gap.missing.begin(), gap.missing.end(),
                        [](std::string const& name) { return name.empty(); }))
            refuse(k, "the sequence does not name all residues",
                   "complete the sequence, or write `gaps: split`");
        return gap;
    }

    /// Place of each site in the sequence relative to the first one. Numbers count the missing
    /// residues; insertion codes may lie elsewhere.
    std::vector<std::int64_t> steps() const {
        std::vector<std::int64_t> place(from_.sites.size(), 0);
        for (std::size_t k = 1; k < from_.sites.size(); ++k) {
            place[k] = place[k - 1] + 1;
            if (!std::binary_search(gaps_.begin(), gaps_.end(), k)) continue;
            auto const &before = from_.sites[k - 1].number, &after = from_.sites[k].number;
            if (!before || !after || *after <= *before + 1)
                refuse(k, "the residue numbers do not say how many residues are missing",
                       "correct the numbers, or write `gaps: split`");
            place[k] += *after - *before - 1;
        }
        return place;
    }
    bool fits(std::vector<std::int64_t> const& place, std::int64_t start) const {
        for (std::size_t k = 0; k < place.size(); ++k)
            if (!same_residue(listed_[static_cast<std::size_t>(start + place[k])],
                              from_.sites[k].residue))
                return false;
        return true;
    }
    std::vector<Gap> by_search() const {
        std::vector<std::int64_t> const place = steps();
        std::vector<Gap> found;
        std::set<ResidueNames> different;
        for (std::int64_t start = 0; start + place.back() < std::ssize(listed_); ++start) {
            if (!fits(place, start)) continue;
            found.clear();
            ResidueNames all;
            for (std::size_t const k : gaps_) {
                found.push_back(between(k, start + place[k - 1] + 1, start + place[k]));
                all.insert(all.end(), found.back().missing.begin(), found.back().missing.end());
            }
            different.insert(all);
        }
        if (different.empty())
            refuse(gaps_.front(), "the residues and their numbers do not fit the file's sequence",
                   "correct SEQRES or the numbers, or write `gaps: split`");
        if (different.size() > 1)
            refuse(gaps_.front(), "the residues fit several places of the file's sequence",
                   "give the file as mmCIF with `label_seq_id`, or write `gaps: split`");
        return found;
    }

    PdbSites const& from_;
    std::vector<std::size_t> const& gaps_;
    Node const& at_;
    ResidueNames const& listed_;
};

/// Numbers of the missing residues: those between both ends if they fit, else the number before the
/// gap with a count.
void number_sites(std::vector<PdbSite>& grown, PdbSite const& before, PdbSite const& after) {
    auto const n = static_cast<std::int64_t>(grown.size());
    bool const counted = before.number && after.number && *after.number - *before.number == n + 1;
    for (std::int64_t i = 0; i < n; ++i) {
        PdbSite& site = grown[static_cast<std::size_t>(i)];
        site.grown = true;
        site.number = before.number;
        if (counted) *site.number += i + 1;
        site.label =
            counted ? std::to_string(*site.number) : fmt::format("{}+{}", before.label, i + 1);
    }
}

/// Grows the linker of one gap.
std::vector<PdbSite> grown_sites(PdbSites const& from, Gap const& gap,
                                 std::vector<Vec3> const& obstacles, ChainRequest const& request,
                                 SequenceSearch const& search) {
    PdbSite const &before = from.sites[gap.site - 1], &after = from.sites[gap.site];
    auto const beads = static_cast<std::int64_t>(gap.missing.size());
    Linker const linker{before.position, after.position, beads, grown_link, excluded_distance};
    double const apart = norm(linker.to - linker.from),
                 most = linker.length * static_cast<double>(beads + 1);
    if (apart > most)
        search.refuse(
            gap.site,
            fmt::format("{} missing residue{} reach{} {:.3f} nm at most, and the ends "
                        "stand {:.3f} nm apart",
                        beads, beads == 1 ? "" : "s", beads == 1 ? "es" : "", most, apart),
            "correct the file, or write `gaps: split`");
    std::vector<Vec3> others;
    for (Vec3 const& point : obstacles)
        if (norm(point - linker.from) > 0 && norm(point - linker.to) > 0) others.push_back(point);
    std::vector<Vec3> const way =
        grow_linker(linker, others, request.seed(static_cast<std::int64_t>(gap.site)));
    if (way.empty())
        search.refuse(
            gap.site,
            fmt::format("no self-avoiding way of {} residues was found between the ends", beads),
            "model the residues with another program, or write `gaps: split`");
    std::vector<PdbSite> grown;
    for (std::size_t i = 0; i < way.size(); ++i) grown.push_back({way[i], gap.missing[i], "", {}});
    number_sites(grown, before, after);
    return grown;
}

}  // namespace

void model_gaps(PdbSites& from, std::vector<std::size_t> const& gaps,
                std::vector<Vec3> const& obstacles, ChainRequest const& request, Node const& at) {
    if (gaps.empty()) return;
    std::vector<Vec3> points = obstacles;
    std::vector<PdbSite> all;
    std::size_t next = 0;
    SequenceSearch const search(from, gaps, at);
    for (Gap const& gap : search.missing()) {
        PdbSite const &before = from.sites[gap.site - 1], &after = from.sites[gap.site];
        std::vector<PdbSite> const grown = grown_sites(from, gap, points, request, search);
        for (PdbSite const& site : grown) points.push_back(site.position);
        all.insert(all.end(), from.sites.begin() + static_cast<std::ptrdiff_t>(next),
                   from.sites.begin() + static_cast<std::ptrdiff_t>(gap.site));
        all.insert(all.end(), grown.begin(), grown.end());
        next = gap.site;
        request.scene.note(fmt::format(
            "`{}`: {} residue{} missing between {} {} and {} {} {} grown as a self-avoiding linker "
            "({})",
            from.file, grown.size(), grown.size() == 1 ? "" : "s", before.residue, before.label,
            after.residue, after.label, grown.size() == 1 ? "is" : "are",
            shown(joined_names(gap.missing), 200)));
    }
    all.insert(all.end(), from.sites.begin() + static_cast<std::ptrdiff_t>(next), from.sites.end());
    from.sites = std::move(all);
}

}  // namespace catena::scene
