// Implements the selection of sites: gathers atoms into residues, then selects one atom each.
#include "scene/pdb_sites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <tuple>

#include "scene/files.hpp"
#include "scene/pdb_file.hpp"
#include "scene/residue_names.hpp"

namespace catena::scene {

namespace {

/// Atoms of one residue, in the file's order.
struct Residue {
    std::vector<PdbAtom> atoms;
    ResidueMeaning meaning;

    PdbAtom const& front() const { return atoms.front(); }
    bool is_protein() const {
        return meaning.kind == ResidueKind::amino_acid || meaning.kind == ResidueKind::charged;
    }
};

Vec3 in_nm(Vec3 const& angstrom) {
    return {{0.1 * angstrom[0], 0.1 * angstrom[1], 0.1 * angstrom[2]}};
}

std::string label_of(PdbAtom const& atom) {
    auto const number = residue_number(atom.number);
    std::string label = number && *number < 10000
                            ? std::to_string(*number)
                            : shown(atom.number);  // larger numbers stay as written
    if (atom.insertion != ' ') label += shown(std::string_view(&atom.insertion, 1));
    return label;
}

/// Returns "ALA 7 of chain A", or the parts of it that the file gives.
std::string name_of(Residue const& residue) {
    PdbAtom const& atom = residue.front();
    std::string text = shown(atom.residue);
    if (!atom.number.empty()) text += " " + label_of(atom);
    if (!chain_of(atom).empty()) text += " of chain " + shown(chain_of(atom));
    return text;
}

/// Gathers atoms into residues. Atoms of a residue need not be consecutive, because alternate
/// locations may form blocks of their own.
class Gathering {
  public:
    Gathering(std::string const& path, Node const& at) : path_(path), at_(at) {}

    void add(PdbAtom const& atom) {
        if (!residues.empty() && continues(atom)) return residues.back().atoms.push_back(atom);
        auto const number = residue_number(atom.number);
        if (number) {
            if (!residues.empty() && !atom.same_chain(residues.back().front())) lap_ = 0;
            if (last_ == 9999 && *number <= 1)
                ++lap_;  // writers without a fifth digit restart at 0 or 1
            auto const key = std::tuple(atom.part, atom.chain, atom.segment, lap_ + realm(atom),
                                        *number, atom.insertion);
            auto const [known, fresh] = known_.try_emplace(key, residues.size());
            if (!fresh) return add_to(residues[known->second], atom);
            last_ = *number;
        }
        residues.push_back({{atom}, meaning_of(atom.residue)});
    }

    std::vector<Residue> residues;

  private:
    /// Separates water and ions from other residues, because their numbers often restart at 1.
    static int realm(PdbAtom const& atom) {
        ResidueKind const kind = meaning_of(atom.residue).kind;
        return kind == ResidueKind::water ? 1 << 20 : kind == ResidueKind::ion ? 2 << 20 : 0;
    }
    /// True if the atom belongs to the residue that was read last.
    bool continues(PdbAtom const& atom) const {
        Residue const& residue = residues.back();
        PdbAtom const& first = residue.front();
        if (!atom.same_chain(first) || atom.number != first.number ||
            atom.insertion != first.insertion)
            return false;
        if (atom.residue != first.residue) return atom.alternate != ' ' && first.alternate != ' ';
        if (residue_number(atom.number)) return true;
        return std::none_of(residue.atoms.begin(), residue.atoms.end(), [&](PdbAtom const& other) {
            return other.name == atom.name && other.alternate == atom.alternate;
        });
    }
    void add_to(Residue& residue, PdbAtom const& atom) {
        if (atom.residue != residue.front().residue &&
            (atom.alternate == ' ' || residue.front().alternate == ' '))
            fail(at_,
                 fmt::format("residue {} of `{}` comes again as {} (line {})", name_of(residue),
                             shown_path(path_), shown(atom.residue), atom.line),
                 "give each residue its own number or insertion code");
        residue.atoms.push_back(atom);
    }

    std::string const& path_;
    Node const& at_;
    std::map<std::tuple<int, std::string_view, std::string_view, int, std::int64_t, char>,
             std::size_t>
        known_;
    std::int64_t last_ = 0;
    /// Number of restarts of the residue numbers within the chain.
    int lap_ = 0;
};

/// Counts the residues that are left out, by kind and name.
class Savings {
  public:
    void add(char const* kind, Residue const& residue) {
        ++counts_[kind][shown(residue.front().residue)];
    }

    void note(std::string const& file, std::vector<std::string>& notes) const {
        for (auto const& [kind, names] : counts_) {
            std::int64_t sum = 0;
            std::string list;
            for (auto const& [name, count] : names) {
                sum += count;
                list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, name);
            }
            notes.push_back(fmt::format("`{}`: {} {}{} left out ({})", file, sum, kind,
                                        sum == 1 ? "" : "s", list));
        }
    }

  private:
    std::map<std::string, std::map<std::string, std::int64_t>> counts_;
};

/// Selects one site per residue and records notes on the choices.
class Selection {
  public:
    Selection(std::vector<Residue> const& residues, std::string const& path, Node const& at)
        : residues_(residues),
          at_(at),
          alpha_carbons_(any_alpha_carbon()),
          protein_(any_protein()) {
        made.file = shown_path(path);
    }

    void take_sites() {
        for (Residue const& residue : residues_) {
            if (char const* const kind = foreign(residue)) {
                left_out_.add(kind, residue);
                continue;
            }
            take_site(residue);
        }
        left_out_.note(made.file, made.notes);
        if (alternates_ > 0)
            made.notes.push_back(
                fmt::format("`{}`: alternate locations in {} residue{}: the one of largest "
                            "occupancy is taken{}",
                            made.file, alternates_, alternates_ == 1 ? "" : "s", mixed_));
    }

    void refuse_several_chains() const {
        std::string list;
        int chains = 0;
        for (std::size_t k = 0, begin = 0; k < from_.size(); ++k) {
            if (k + 1 < from_.size() && from_[k]->same_chain(*from_[k + 1])) continue;
            if (++chains <= 4)
                list += fmt::format("{}{}", chains == 1 ? "" : ", ", range(begin, k));
            begin = k + 1;
        }
        if (chains > 1)
            fail(at_,
                 fmt::format("`{}` holds {} chains: {}{}", made.file, chains, list,
                             chains > 4 ? ", ..." : ""),
                 "keep one chain per file, each with its own entry in `chains`");
    }

    /// Notes missing residues. SEQRES lists the residues of the whole chain.
    void note_unresolved(PdbSummary const& summary) {
        if (from_.empty()) return;
        auto const listed = summary.sequence.find(std::string(from_[0]->chain));
        if (listed == summary.sequence.end() || listed->second <= std::ssize(made.sites)) return;
        made.notes.push_back(
            fmt::format("`{}`: SEQRES lists {} residues of the chain, but only {} have positions "
                        "and become beads",
                        made.file, listed->second, made.sites.size()));
    }

    PdbSites made;

  private:
    bool any_alpha_carbon() const {
        for (Residue const& residue : residues_)
            for (PdbAtom const& atom : residue.atoms)
                if (is_alpha_carbon(residue, atom) && !is_solvent(residue)) return true;
        return false;
    }
    bool any_protein() const {
        return std::any_of(residues_.begin(), residues_.end(),
                           [](Residue const& r) { return r.is_protein(); });
    }
    /// True for an alpha carbon. Calcium has the same name, but begins in column 13 and has the
    /// element CA.
    static bool is_alpha_carbon(Residue const& residue, PdbAtom const& atom) {
        if (atom.name != "CA") return false;
        return residue.is_protein() || !(atom.at_margin && atom.element != "C");
    }
    /// True for water and ions. A residue name of one letter may be a one-letter amino acid code;
    /// then the atom must have that name, too.
    static bool is_solvent(Residue const& residue) {
        PdbAtom const& atom = residue.front();
        if (residue.meaning.kind == ResidueKind::water)
            return atom.residue.size() > 1 || atom.name == atom.residue;
        if (residue.meaning.kind != ResidueKind::ion || !is_one_atom(residue)) return false;
        return atom.residue.size() > 1 ? !is_carbon(atom) : atom.name == atom.residue;
    }
    static bool is_one_atom(Residue const& residue) {
        return std::all_of(residue.atoms.begin(), residue.atoms.end(),
                           [&](PdbAtom const& atom) { return atom.name == residue.front().name; });
    }
    static bool is_carbon(PdbAtom const& atom) {
        return atom.name == "CA" && !atom.at_margin && atom.element == "C";
    }

    /// Returns the kind of a residue that is not a bead, or nullptr for a bead.
    char const* foreign(Residue const& residue) const {
        PdbAtom const& atom = residue.front();
        if (is_solvent(residue))
            return residue.meaning.kind == ResidueKind::water ? "water" : "ion";
        if (residue.meaning.kind == ResidueKind::cap) return "cap";
        if (residue.is_protein() || !protein_) return nullptr;
        bool const het = std::all_of(residue.atoms.begin(), residue.atoms.end(),
                                     [](PdbAtom const& a) { return a.het; });
        bool const has_site =
            std::any_of(residue.atoms.begin(), residue.atoms.end(),
                        [&](PdbAtom const& a) { return is_alpha_carbon(residue, a); });
        if (!het || has_site) return nullptr;
        return is_one_atom(residue) && atom.name == atom.residue ? "ion" : "ligand";
    }

    /// Atoms that may be the residue's site: alternate locations of one atom.
    std::vector<PdbAtom const*> candidates(Residue const& residue) const {
        std::vector<PdbAtom const*> found;
        for (PdbAtom const& atom : residue.atoms)
            if (!alpha_carbons_ || is_alpha_carbon(residue, atom)) found.push_back(&atom);
        if (found.empty())
            fail(at_,
                 fmt::format("residue {} of `{}` has no CA atom (line {})", name_of(residue),
                             made.file, residue.front().line),
                 "add it, or take the residue out of the file");
        for (PdbAtom const* const atom : found)
            if (atom->name != found.front()->name)
                fail(at_,
                     fmt::format("residue {} of `{}` has several atoms and none is its only CA",
                                 name_of(residue), made.file),
                     "keep one atom per residue");
        for (auto a = found.begin(); a != found.end(); ++a)
            for (auto b = found.begin(); b != a; ++b)
                if ((*a)->alternate == (*b)->alternate)
                    fail(at_,
                         fmt::format("residue {} of `{}` has atom {} twice (lines {} and {})",
                                     name_of(residue), made.file, shown((*a)->name), (*b)->line,
                                     (*a)->line),
                         "keep one of them");
        return found;
    }

    void take_site(Residue const& residue) {
        std::vector<PdbAtom const*> const all = candidates(residue);
        PdbAtom const& atom = **std::max_element(
            all.begin(), all.end(), [](auto* a, auto* b) { return a->occupancy < b->occupancy; });
        refuse_lost_alternate(residue, all, atom);
        if (all.size() > 1) {
            ++alternates_;
            for (PdbAtom const* const other : all)
                if (other->residue != atom.residue)
                    mixed_ = fmt::format("; {} is taken, not {}", name_of(residue_of(atom)),
                                         shown(other->residue));
        }
        made.sites.push_back({in_nm(atom.position), shown(atom.residue), label_of(atom),
                              residue_number(atom.number), beside(residue, atom, "C"),
                              beside(residue, atom, "N")});
        from_.push_back(&atom);
    }
    /// Throws InputError if a preferred alternate location lacks the site's atom.
    void refuse_lost_alternate(Residue const& residue, std::vector<PdbAtom const*> const& all,
                               PdbAtom const& taken) const {
        for (PdbAtom const& atom : residue.atoms) {
            bool const has_site = std::any_of(all.begin(), all.end(), [&](auto* site) {
                return site->alternate == atom.alternate;
            });
            bool const preferred = atom.occupancy > taken.occupancy ||
                                   (atom.occupancy == taken.occupancy && atom.line < taken.line);
            if (taken.alternate == ' ' || atom.alternate == ' ' || has_site || !preferred) continue;
            fail(at_,
                 fmt::format("residue {} of `{}` has no {} atom in alternate location {} (line {})",
                             name_of(residue), made.file, shown(taken.name),
                             shown(std::string_view(&atom.alternate, 1)), atom.line),
                 "add it, or take the location out of the file");
        }
    }
    static Residue residue_of(PdbAtom const& atom) { return {{atom}, {}}; }

    /// Position of the atom `name` of the site's alternate location or of none, nm. Only alpha
    /// carbons have such neighbours.
    static std::optional<Vec3> beside(Residue const& residue, PdbAtom const& site,
                                      std::string_view name) {
        for (PdbAtom const& atom : residue.atoms)
            if (site.name == "CA" && atom.name == name &&
                (atom.alternate == ' ' || atom.alternate == site.alternate))
                return in_nm(atom.position);
        return {};
    }

    std::string range(std::size_t begin, std::size_t end) const {
        std::string const name =
            chain_of(*from_[begin]).empty() ? "no name" : shown(chain_of(*from_[begin]));
        std::string const first = made.sites[begin].label, last = made.sites[end].label;
        return begin == end ? fmt::format("{} (residue {})", name, first)
                            : fmt::format("{} (residues {} to {})", name, first, last);
    }

    std::vector<Residue> const& residues_;
    Node const& at_;
    bool alpha_carbons_, protein_;
    std::vector<PdbAtom const*> from_;  // one per site
    Savings left_out_;
    int alternates_ = 0;
    std::string mixed_;
};

}  // namespace

std::vector<Vec3> PdbSites::positions() const {
    std::vector<Vec3> all;
    all.reserve(sites.size());
    for (PdbSite const& site : sites) all.push_back(site.position);
    return all;
}

PdbSites read_pdb(std::string const& path, Node const& at, bool single_chain) {
    std::string const text = read_text_file(path, at);
    Gathering gathering(path, at);
    PdbSummary const summary = for_each_pdb_atom(text, shown_path(path),
                                                 [&](PdbAtom const& atom) { gathering.add(atom); });
    if (summary.atoms == 0) fail(at, "no atoms in `" + shown_path(path) + "`", "give ATOM records");
    Selection selection(gathering.residues, path, at);
    selection.take_sites();
    if (summary.cell) selection.made.cell = in_nm(*summary.cell);
    if (selection.made.sites.empty())
        fail(at, "no residues of a chain in `" + shown_path(path) + "`",
             "give ATOM records of a chain");
    if (summary.models > 1)
        selection.made.notes.push_back(fmt::format("`{}`: {} models, the first is taken",
                                                   selection.made.file, summary.models));
    if (single_chain) {
        selection.refuse_several_chains();
        selection.note_unresolved(summary);
    }
    return std::move(selection.made);
}

}  // namespace catena::scene
