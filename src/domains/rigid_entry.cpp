// Implements the reader of `rigid`.
#include "domains/rigid_entry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "domains/domain_file.hpp"
#include "domains/range_forms.hpp"
#include "keys/maps.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"

namespace catena::scene {

namespace {

/// Least number of residues of a body.
std::size_t constexpr least_residues = 3;

/// A range of residues by their indices.
Domain range_of(std::size_t first, std::size_t last, ResidueNumbers const& numbers) {
    return {first, last, numbers.span(first, last)};
}

/// Sorts the ranges of one body and joins those of one chain that overlap or are at most `loop`
/// residues apart.
void join_ranges(RigidSet& set, ResidueNumbers const& numbers, std::size_t loop) {
    std::sort(set.ranges.begin(), set.ranges.end(),
              [](Domain const& a, Domain const& b) { return a.first < b.first; });
    std::vector<Domain> joined;
    for (Domain const& range : set.ranges) {
        bool const near = !joined.empty() && range.first <= joined.back().last + loop + 1 &&
                          numbers.chain_of(range.first) == numbers.chain_of(joined.back().first);
        if (near)
            joined.back() =
                range_of(joined.back().first, std::max(joined.back().last, range.last), numbers);
        else
            joined.push_back(range);
    }
    set.ranges = joined;
}

bool overlap(RigidSet const& a, RigidSet const& b) {
    for (Domain const& one : a.ranges)
        for (Domain const& other : b.ranges)
            if (one.first <= other.last && other.first <= one.last) return true;
    return false;
}

/// Joins bodies that share residues, such as a domain within a loop that became rigid.
void join_overlapping(std::vector<RigidSet>& sets, ResidueNumbers const& numbers) {
    for (std::size_t i = 0; i < sets.size(); ++i)
        for (std::size_t j = i + 1; j < sets.size();) {
            if (!overlap(sets[i], sets[j])) {
                ++j;
                continue;
            }
            sets[i].ranges.insert(sets[i].ranges.end(), sets[j].ranges.begin(),
                                  sets[j].ranges.end());
            sets.erase(sets.begin() + static_cast<std::ptrdiff_t>(j));
            join_ranges(sets[i], numbers, 0);
            j = i + 1;  // the larger body may meet others
        }
}

/// Throws InputError for a range over several chains.
void refuse_across(RigidSet const& set, ResidueNumbers const& numbers) {
    for (Domain const& range : set.ranges) {
        if (numbers.chain_of(range.first) == numbers.chain_of(range.last)) continue;
        std::size_t const end = numbers.range_of(numbers.chain_of(range.first))[1] - 1;
        bool const several = numbers.several_names();
        fail(*set.at, range.name + " do not lie in one chain",
             fmt::format("end the domain where its chain ends; for one body of both parts write a "
                         "list of ranges, [\"{}{}-{}\", ...]",
                         several ? numbers.chains[range.first][0] + ":" : "",
                         numbers.label(range.first), numbers.label(end)));
    }
}

/// Throws InputError for bodies that are too small.
void refuse_small(RigidSet const& set, std::string const& remedy) {
    std::size_t residues = 0;
    for (Domain const& range : set.ranges) residues += range.last - range.first + 1;
    if (residues < least_residues)
        fail(*set.at,
             set.name() +
                 " do not form a rigid body, which needs three residues that do not lie on one "
                 "line",
             remedy);
}

/// Throws InputError if two ranges share residues.
void refuse_overlaps(std::vector<RigidSet> const& sets) {
    std::vector<Domain const*> taken;
    for (RigidSet const& set : sets)
        for (Domain const& range : set.ranges) {
            for (Domain const* const other : taken)
                if (range.first <= other->last && other->first <= range.last)
                    fail(*set.at,
                         fmt::format("{} overlap the domain{}", range.name,
                                     other->name.substr(other->name.find(' '))),
                         "assign each residue to one domain");
            taken.push_back(&range);
        }
}

/// "11 to 89, 105 to 179": ranges of all bodies.
std::string listed(std::vector<RigidSet> const& sets, ResidueNumbers const& numbers) {
    bool const beads = !numbers.count_from_one();
    std::string text;
    for (RigidSet const& set : sets) {
        text += text.empty() ? "" : ", ";
        for (std::size_t r = 0; r < set.ranges.size(); ++r) {
            Domain const& range = set.ranges[r];
            text += fmt::format("{}{}-{}", r == 0 ? "" : " with ", numbers.label(range.first),
                                numbers.label(range.last));
            if (beads) text += fmt::format(" (beads {}-{})", range.first + 1, range.last + 1);
        }
    }
    return text;
}

/// Reads `rigid` as a map.
class RigidMap {
  public:
    RigidMap(Node const& rigid, RigidSource const& source)
        : fields_(rigid, keys::rigid), rigid_(rigid), source_(source) {}

    RigidBodies read() {
        Node const* const file = fields_.find("domains");
        Node const* const pae = fields_.find("pae");
        if (!file == !pae)
            fail(rigid_,
                 file ? "`rigid` has both `domains` and `pae`"
                      : "`rigid` has neither `domains` nor `pae`",
                 "keep one of them, or write a list of ranges");
        if (source_.numbers.number_of_chains() > 1)
            fail(rigid_,
                 fmt::format("`{}` decides the domains of one chain, and the entry has {}",
                             file ? "domains" : "pae", source_.numbers.number_of_chains()),
                 "give each chain its own entry with `chain`, or write a list of ranges");
        refuse_others(file ? Others{"plddt", "max_pae", "min_length"} : Others{"protein"},
                      file ? "domains" : "pae");
        file ? by_file(*file) : by_prediction(*pae);
        return std::move(made_);
    }

  private:
    using Others = std::vector<std::string_view>;

    void refuse_others(Others const& others, char const* source) const {
        for (std::string_view const key : others)
            if (Node const* const here = fields_.find(key))
                fail(*here, fmt::format("key `{}` does not apply to `{}`", key, source),
                     "leave it out");
    }
    std::int64_t count(char const* key, std::int64_t otherwise, std::int64_t least) const {
        Node const* const node = fields_.find(key);
        return node ? whole(*node, least, std::int64_t{1000000}) : otherwise;
    }
    void add(RigidSet set) {
        set.at = &rigid_;
        made_.sets.push_back(std::move(set));
    }

    void by_file(Node const& file) {
        auto const grown = std::count(source_.grown.begin(), source_.grown.end(), true);
        if (grown > 0)
            fail(file,
                 fmt::format("a domain file counts the residues of a structure without gaps, and "
                             "{} of this one are grown",
                             grown),
                 "write the domains as ranges of the structure's residue numbers");
        auto const loop = static_cast<std::size_t>(count("longest_loop", 0, 0));
        Node const* const protein = fields_.find("protein");
        FileDomains const read = read_domain_file(resolved(text(file), source_.scene_file), file,
                                                  protein ? text(*protein) : "", source_.name);
        auto const residues = static_cast<std::int64_t>(source_.numbers.residues);
        for (DomainSegments const& domain : read.domains) {
            RigidSet set;
            for (auto const& [first, last] : domain) {
                if (last > residues)
                    fail(file,
                         fmt::format("`{}` ends a domain of {} at residue {} of a chain of {}",
                                     shown_path(file.text), shown(read.protein), last, residues),
                         "its numbers count residues along the chain from 1: give the file and "
                         "`protein` of this chain");
                set.ranges.push_back(range_of(static_cast<std::size_t>(first) - 1,
                                              static_cast<std::size_t>(last) - 1, source_.numbers));
            }
            add(std::move(set));
        }
        refuse_overlaps(made_.sets);
        for (RigidSet& set : made_.sets) join_ranges(set, source_.numbers, loop);
        join_overlapping(made_.sets, source_.numbers);
        note(fmt::format("`{}`, protein {}", shown_path(file.text), shown(read.protein)), "");
    }

    void by_prediction(Node const& file) {
        DomainThresholds limits;
        if (Node const* const node = fields_.find("plddt")) limits.plddt = percentage(*node);
        if (Node const* const node = fields_.find("max_pae")) limits.pae = positive(*node);
        limits.min_length = count("min_length", limits.min_length, least_residues);
        limits.longest_loop = count("longest_loop", limits.longest_loop, 0);
        Prediction found{confidences(file),
                         read_predicted_error(resolved(text(file), source_.scene_file), file),
                         limits,
                         {}};
        refuse_fraction(limits.plddt, found.plddt);
        refuse_other_size(file, found);
        ConfidentDomains const decided = confident_domains(found.plddt, found.error, limits);
        if (decided.domains.empty())
            fail(file,
                 fmt::format("no {} residues in a row have a pLDDT of {:g} and more and an error "
                             "of {:g} angstrom at most",
                             limits.min_length, limits.plddt, limits.pae),
                 "leave `rigid` out, or change `plddt`, `max_pae` or `min_length`");
        for (auto const& segments : decided.domains) {
            RigidSet set;
            for (auto const& [first, last] : segments)
                set.ranges.push_back(range_of(first, last, source_.numbers));
            add(std::move(set));
        }
        join_overlapping(made_.sets, source_.numbers);
        for (RigidSet const& set : made_.sets)
            for (Domain const& range : set.ranges)
                found.domains.push_back({range.first, range.last});
        std::sort(found.domains.begin(), found.domains.end());
        note(fmt::format("`{}`, pLDDT {:g} and more, errors of {:g} angstrom at most",
                         shown_path(file.text), limits.plddt, limits.pae),
             flexible_text(found, decided));
        made_.prediction = std::make_shared<Prediction const>(std::move(found));
    }

    /// Throws InputError for a threshold from 0 to 1 beside confidences from 0 to 100.
    void refuse_fraction(double threshold, std::vector<double> const& plddt) const {
        if (!(threshold > 0 && threshold <= 1)) return;
        fail(*fields_.find("plddt"),
             fmt::format("a pLDDT of {:g}, where those of the structure reach {:.3g}", threshold,
                         *std::max_element(plddt.begin(), plddt.end())),
             fmt::format("give it from 0 to 100, such as {:g}", 100 * threshold));
    }
    /// Throws InputError unless structure and errors have the same number of residues.
    static void refuse_other_size(Node const& file, Prediction const& found) {
        std::size_t const structure = found.plddt.size(), errors = found.error.residues;
        if (structure == errors) return;
        fail(file,
             fmt::format("the structure has {} residues and `{}` the errors of {}", structure,
                         shown_path(file.text), errors),
             fmt::format("if both are of one protein, {} is cut short: copy it again, or else give "
                         "the errors of this structure",
                         structure < errors ? "the structure" : "the file of errors"));
    }
    static double percentage(Node const& node) {
        double const value = number(node);
        if (!(value >= 0 && value <= 100))
            fail(node, fmt::format("a pLDDT of {:g}", value), "give a number from 0 to 100");
        return value;
    }
    /// pLDDT of each residue, from the B factors.
    std::vector<double> confidences(Node const& file) const {
        std::string const remedy =
            "give a predicted structure as `pdb`, with pLDDT from 0 to 100 as B factors";
        if (source_.b_factors.empty())
            fail(file, "`pae` without a structure that holds pLDDT", remedy);
        std::vector<double> all;
        for (std::size_t k = 0; k < source_.b_factors.size(); ++k) {
            double const value = source_.b_factors[k].value_or(-1);
            if (!(value >= 0 && value <= 100))
                fail(file,
                     source_.b_factors[k]
                         ? fmt::format("the B factor {:g} of residue {} is no pLDDT", value,
                                       source_.numbers.label(k))
                         : fmt::format("residue {} has no B factor", source_.numbers.label(k)),
                     remedy);
            all.push_back(value);
        }
        double const most = *std::max_element(all.begin(), all.end());
        if (most <= 1)
            fail(file,
                 most == 0 ? "all B factors are 0: they are no pLDDT"
                           : "no B factor exceeds 1: they are no pLDDT from 0 to 100",
                 remedy);
        return all;
    }
    /// Confident residues that stay flexible.
    static std::string flexible_text(Prediction const& found, ConfidentDomains const& decided) {
        std::size_t residues = 0;
        for (Segment const& segment : decided.short_segments)
            residues += segment[1] - segment[0] + 1;
        for (Segment const& segment : decided.short_segments)
            for (Segment const& domain : found.domains)
                if (segment[0] >= domain[0] && segment[1] <= domain[1])
                    residues -= segment[1] - segment[0] + 1;
        return residues == 0
                   ? ""
                   : fmt::format("; {} residue{} of that pLDDT in segments below {} stay flexible",
                                 residues, residues == 1 ? "" : "s", found.thresholds.min_length);
    }
    void note(std::string const& by, std::string const& more) {
        std::sort(made_.sets.begin(), made_.sets.end(), [](RigidSet const& a, RigidSet const& b) {
            return a.ranges[0].first < b.ranges[0].first;
        });
        made_.notes.push_back(fmt::format("chain `{}`: {} rigid domain{} by {}: residues {}{}",
                                          shown(source_.name), made_.sets.size(),
                                          made_.sets.size() == 1 ? "" : "s", by,
                                          listed(made_.sets, source_.numbers), more));
    }

    Fields fields_;
    Node const& rigid_;
    RigidSource const& source_;
    RigidBodies made_;
};

/// Notes residues in rigid bodies whose places no file gives.
void note_grown(RigidSource const& source, RigidBodies& made) {
    std::vector<std::size_t> grown;
    for (RigidSet const& set : made.sets)
        for (Domain const& range : set.ranges)
            for (std::size_t k = range.first; k <= range.last && k < source.grown.size(); ++k)
                if (source.grown[k]) grown.push_back(k);
    if (grown.empty()) return;
    made.notes.push_back(fmt::format(
        "{} grown residue{} in rigid bodies keep{} the random shape of the start (first: {})",
        grown.size(), grown.size() == 1 ? "" : "s", grown.size() == 1 ? "s" : "",
        source.numbers.span(grown[0], grown[0])));
}

/// Notes residues with insertion codes that follow the end of a range and are not in it.
void note_insertions(Numbering const& by, RigidBodies& made) {
    for (RigidSet const& set : made.sets)
        for (Domain const& range : set.ranges)
            if (std::string const names = by.left_out_insertions(range); !names.empty())
                made.notes.push_back(fmt::format(
                    "the rigid {} end before {}, which share the last number; name the last of "
                    "them to include them",
                    range.name, names));
}

RigidBodies read_list(Node const& rigid, ResidueNumbers const& numbers, Numbering const& by) {
    refuse_no_list(rigid, by.chain_names());
    if (rigid.items.empty())
        fail(rigid, "the list of rigid domains is empty", "leave the key out or " + by.remedy());
    RigidBodies made;
    for (Node const& item : rigid.items) {
        RigidSet set{{}, &item};
        if (Numbering::is_list_of_ranges(item))
            for (Node const& each : item.items) set.ranges.push_back(by.range(each));
        else
            set.ranges.push_back(by.range(item));
        refuse_small(set, by.remedy());
        refuse_across(set, numbers);
        made.sets.push_back(std::move(set));
    }
    refuse_overlaps(made.sets);
    for (RigidSet& set : made.sets) join_ranges(set, numbers, 0);
    note_insertions(by, made);
    return made;
}

}  // namespace

RigidBodies read_rigid_bodies(Node const& rigid, RigidSource const& source) {
    Numbering const numbering(source.numbers);
    bool const keyed =
        rigid.kind == Node::Kind::map && (rigid.find("domains") || rigid.find("pae"));
    IsChain const is_chain = numbering.chain_names();
    if (!keyed && is_map_of_ranges(rigid, is_chain)) refuse_map(rigid, is_chain);
    RigidBodies made = rigid.kind == Node::Kind::map ? RigidMap(rigid, source).read()
                                                     : read_list(rigid, source.numbers, numbering);
    if (rigid.kind == Node::Kind::map)
        for (RigidSet const& set : made.sets) refuse_small(set, "correct the file");
    std::sort(made.sets.begin(), made.sets.end(), [](RigidSet const& a, RigidSet const& b) {
        return a.ranges[0].first < b.ranges[0].first;
    });
    note_grown(source, made);
    return made;
}

}  // namespace catena::scene
