// Implements the selection of sites: the atoms of the chosen chains become residues, and each
// residue one site.
#include "structure/pdb_sites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scene/files.hpp"
#include "structure/atom_masses.hpp"
#include "structure/residue_names.hpp"
#include "structure/structure_file.hpp"
#include "structure/structure_residues.hpp"

namespace catena::scene {

namespace {

using Residue = StructureResidue;

Vec3 in_nm(Vec3 const& angstrom) {
    return {{0.1 * angstrom[0], 0.1 * angstrom[1], 0.1 * angstrom[2]}};
}

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
    Selection(std::vector<Residue> const& residues, std::string const& path, Node const& at,
              bool mass_centres)
        : residues_(residues),
          at_(at),
          mass_centres_(mass_centres),
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
        if (lone_atoms_ > 0)
            made.notes.push_back(fmt::format(
                "`{}`: `sites: com` finds a single atom in {} residue{}, which is taken "
                "for the centre of mass",
                made.file, lone_atoms_, lone_atoms_ == 1 ? "" : "s"));
    }

    /// Lists the chains, with their sequences in the file.
    void list_chains(PdbSummary const& summary) {
        for (std::size_t k = 0; k < from_.size(); ++k) {
            if (k == 0 || !from_[k]->same_chain(*from_[k - 1])) {
                made.chains.push_back({shown(chain_of(*from_[k])), shown(from_[k]->label), k});
                auto const listed = summary.sequence.find(std::string(from_[k]->label));
                if (listed != summary.sequence.end()) made.chains.back().sequence = listed->second;
            }
            made.chains.back().last = k + 1;
        }
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
                 fmt::format("residue {} of `{}` has no CA atom ({})", name_of(residue), made.file,
                             place_of(residue.front())),
                 is_nucleotide(residue.front().residue)
                     ? nucleotide_remedy
                     : "add it, or take the residue out of the file");
        for (PdbAtom const* const atom : found)
            if (atom->name != found.front()->name)
                fail(at_,
                     fmt::format("residue {} of `{}` has several atoms and none is its only CA",
                                 name_of(residue), made.file),
                     is_nucleotide(residue.front().residue) ? nucleotide_remedy
                                                            : "keep one atom per residue");
        for (auto a = found.begin(); a != found.end(); ++a)
            for (auto b = found.begin(); b != a; ++b)
                if ((*a)->alternate == (*b)->alternate)
                    fail(at_,
                         fmt::format("residue {} of `{}` has atom {} twice ({}s {} and {})",
                                     name_of(residue), made.file, shown((*a)->name),
                                     (*a)->row ? "row" : "line", (*b)->line, (*a)->line),
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
        made.sites.back().sequence_index = atom.sequence_index;
        made.sites.back().b_factor = atom.b_factor;
        if (mass_centres_) made.sites.back().position = mass_centre(residue, atom);
        from_.push_back(&atom);
    }
    /// Centre of mass, nm, of the residue's atoms in the site's alternate location and in none.
    Vec3 mass_centre(Residue const& residue, PdbAtom const& site) {
        double sum = 0;
        Vec3 centre = Vec3::zero();
        int atoms = 0;
        for (PdbAtom const& atom : residue.atoms) {
            if (atom.alternate != ' ' && site.alternate != ' ' && atom.alternate != site.alternate)
                continue;
            auto const mass = atom_mass(atom);
            if (!mass)
                fail(at_,
                     fmt::format("atom {} of residue {} of `{}` has no known mass ({})",
                                 shown(atom.name), name_of(residue), made.file, place_of(atom)),
                     "give its element, or write `sites: ca`");
            sum += *mass;
            centre = plus_scaled(centre, *mass, atom.position - site.position);
            ++atoms;
        }
        if (atoms == 1) ++lone_atoms_;
        return in_nm(site.position + (1 / sum) * centre);
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
                 fmt::format("residue {} of `{}` has no {} atom in alternate location {} ({})",
                             name_of(residue), made.file, shown(taken.name),
                             shown(std::string_view(&atom.alternate, 1)), place_of(atom)),
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

    std::vector<Residue> const& residues_;
    Node const& at_;
    bool mass_centres_, alpha_carbons_, protein_;
    std::vector<PdbAtom const*> from_;  // one per site
    Savings left_out_;
    int alternates_ = 0, lone_atoms_ = 0;
    std::string mixed_;
};

/// The chains that are read, by their names.
class ChainFilter {
  public:
    /// Finds the chosen names among the file's atoms: a name that the authors gave precedes a
    /// label. Throws InputError for a name that is neither.
    ChainFilter(StructureChoice const& choice, StructureFile const& file, std::string const& path,
                Node const& at) {
        all_ = choice.chains.empty();
        if (all_) return;
        std::vector<Known> known;
        PdbSummary const summary = file.for_each_atom(choice.model, [&](PdbAtom const& atom) {
            auto const same = [&](Known const& chain) {
                return chain.name == chain_of(atom) && chain.label == atom.label;
            };
            auto found = std::find_if(known.begin(), known.end(), same);
            if (found == known.end())
                found = known.insert(found, {std::string(chain_of(atom)), std::string(atom.label)});
            found->polymer = found->polymer || !atom.het;
        });
        if (summary.atoms == 0) return;  // refused with a better reason
        for (std::string const& name : choice.chains) choose(name, known, path, at);
        for (Known const& chain : known)
            if (chain.polymer && !takes(chain.name, chain.label) && !is_in(others, chain.name))
                others.push_back(chain.name);
    }

    bool takes(std::string_view name, std::string_view label) const {
        return all_ || is_in(names_, name) || is_in(labels_, label);
    }

    /// Sentences on names that mean another chain by their label.
    std::vector<std::string> notes;
    /// Names of the polymer chains that are not chosen.
    std::vector<std::string> others;

  private:
    static bool is_in(std::vector<std::string> const& list, std::string_view name) {
        return std::find(list.begin(), list.end(), name) != list.end();
    }

    /// A chain of the file.
    struct Known {
        std::string name, label;
        bool polymer = false;  // it has ATOM records
    };

    void choose(std::string const& name, std::vector<Known> const& known, std::string const& path,
                Node const& at) {
        auto const named = [&](Known const& chain) { return chain.name == name; };
        auto const labelled = [&](Known const& chain) { return chain.label == name; };
        auto const other = std::find_if(known.begin(), known.end(), [&](Known const& chain) {
            return labelled(chain) && !named(chain) && chain.polymer;
        });
        if (std::any_of(known.begin(), known.end(), named)) {
            names_.push_back(name);
            if (other != known.end())
                notes.push_back(fmt::format(
                    "`{}`: {} means the chain that the authors call so, not {}, whose label is {}",
                    path, shown(name), shown(other->name), shown(name)));
        } else if (std::any_of(known.begin(), known.end(), labelled)) {
            labels_.push_back(name);
        } else {
            fail(at, fmt::format("`{}` holds no chain {}", path, shown(name)),
                 "take one of " + listed(known));
        }
    }
    /// The first few names, each once.
    static std::string listed(std::vector<Known> const& known) {
        std::vector<std::string> names;
        for (Known const& chain : known)
            if (std::find(names.begin(), names.end(), chain.name) == names.end())
                names.push_back(chain.name);
        std::string text;
        for (std::size_t k = 0; k < std::min<std::size_t>(names.size(), 8); ++k)
            text += (k == 0 ? "" : ", ") + (names[k].empty() ? "(no name)" : shown(names[k]));
        return names.size() > 8 ? text + ", ..." : text;
    }

    bool all_ = false;
    std::vector<std::string> names_, labels_;
};

/// Number of disulfide bridges that a file lists: records SSBOND, or rows `disulf1 ...` of
/// `_struct_conn`.
std::int64_t listed_bridges(std::string_view text) {
    std::int64_t count = 0;
    for (std::size_t at = 0; at < text.size();) {
        std::string_view const line = text.substr(at, 7);
        count += line.starts_with("SSBOND") || (line.starts_with("disulf") && line.size() > 6 &&
                                                line[6] >= '0' && line[6] <= '9');
        at = text.find('\n', at);
        at = at == std::string_view::npos ? text.size() : at + 1;
    }
    return count;
}

/// Notes that bridges are not read.
void note_bridges(std::int64_t bridges, PdbSites& made) {
    if (bridges > 0)
        made.notes.push_back(fmt::format(
            "`{}`: {} that the file lists {} not read; `crosslinks` joins beads", made.file,
            bridges == 1 ? "a disulfide bridge" : fmt::format("{} disulfide bridges", bridges),
            bridges == 1 ? "is" : "are"));
}

/// Notes further models and data blocks that are not read, and files that end too early.
void note_models(PdbSummary const& summary, StructureChoice const& choice, PdbSites& made) {
    if (summary.models.size() > 1 && !choice.model)
        made.notes.push_back(
            fmt::format("`{}`: {} models, the first is taken", made.file, summary.models.size()));
    if (!summary.cut.empty())
        made.notes.push_back(
            fmt::format("`{}`: {}: the file may be cut, and atoms or chains lost; get it anew, or "
                        "end it by END if it is whole",
                        made.file, summary.cut));
    if (summary.blocks > 1)
        made.notes.push_back(fmt::format("`{}`: {} data blocks with atoms, the first is taken",
                                         made.file, summary.blocks));
}

/// Throws InputError if the file has no atoms, or none in the chosen model.
void refuse_no_atoms(PdbSummary const& summary, StructureChoice const& choice,
                     std::string const& path, Node const& at) {
    if (summary.atoms > 0) return;
    if (summary.models.empty()) fail(at, "no atoms in `" + path + "`", "give ATOM records");
    fail(at, fmt::format("`{}` holds no model {}", path, choice.model.value_or(1)),
         summary.models.size() == 1
             ? fmt::format("leave `conformer` out: its only model is {}", summary.models[0])
             : fmt::format("its {} models are {} to {}", summary.models.size(),
                           summary.models.front(), summary.models.back()));
}

}  // namespace

std::vector<Vec3> PdbSites::positions() const {
    std::vector<Vec3> all;
    all.reserve(sites.size());
    for (PdbSite const& site : sites) all.push_back(site.position);
    return all;
}

PdbSites read_pdb(std::string const& path, Node const& at, StructureChoice const& choice) {
    std::string const name = shown_path(path);
    StructureFile const file(read_text_file(path, at), name);
    ChainFilter const filter(choice, file, name, at);
    ResidueGathering gathering(path, at);
    PdbSummary const summary = file.for_each_atom(choice.model, [&](PdbAtom const& atom) {
        if (filter.takes(chain_of(atom), atom.label)) gathering.add(atom);
    });
    refuse_no_atoms(summary, choice, name, at);
    Selection selection(gathering.residues, path, at, choice.mass_centres);
    selection.take_sites();
    if (summary.cell) selection.made.cell = in_nm(*summary.cell);
    if (selection.made.sites.empty())
        fail(at, "no residues of a chain in `" + name + "`", "give ATOM records of a chain");
    note_models(summary, choice, selection.made);
    note_bridges(listed_bridges(file.text()), selection.made);
    selection.made.notes.insert(selection.made.notes.end(), filter.notes.begin(),
                                filter.notes.end());
    selection.made.other_chains = filter.others;
    selection.list_chains(summary);
    return std::move(selection.made);
}

}  // namespace catena::scene
