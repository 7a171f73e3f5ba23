// Implements the comparison of tables. The package (version 0.8, calvados/components.py) reads them
// by the paths in config.yaml and components.yaml, which may be those of another machine.
#include "foreign/calvados_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "error.hpp"
#include "foreign/calvados_forces.hpp"
#include "io/output_file.hpp"
#include "scene/fields.hpp"
#include "structure/calvados2.hpp"
#include "structure/calvados_rna.hpp"
#include "structure/fasta.hpp"
#include "structure/residue_table.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;
using scene::Node;

constexpr double most_charge = 1e-3;  // e
constexpr char const* put_right =
    "start the package's run.py again, which writes the System, or put the right file there";

/// A node that names a file in messages.
Node named(std::string const& text) {
    Node node;
    node.kind = Node::Kind::scalar;
    node.text = text;
    return node;
}

/// Ways in which restraints count particles: not at all, by the molecules' names, or as version 0.8
/// of the package does, where a component begins after the molecules of the preceding one alone.
enum class Numbering { none, of_names, of_package };

/// Lines such as "A 1 72 | A 1 157 | 0.559 700.0": two beads, each with molecule and bead from 1,
/// then length in nm and stiffness.
class RestraintFile {
  public:
    /// Reads lengths and stiffnesses. Throws InputError for lines without them.
    explicit RestraintFile(std::string const& file) : file_(file) { read(); }
    /// Reads the beads, too. Throws InputError for beads that the components do not have.
    RestraintFile(std::string const& file, CalvadosComponents const& components,
                  std::vector<Molecules> const& molecules)
        : file_(file), components_(&components), molecules_(&molecules) {
        read();
    }
    std::vector<BondText> const& bonds(Numbering numbering) const {
        return bonds_[static_cast<std::size_t>(numbering)];
    }

  private:
    void read() {
        std::istringstream lines(read_text_file(file_));
        for (std::string line; std::getline(lines, line);) {
            ++number_;
            if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
            BondText bond = numbers_of(line);
            bonds_[0].push_back(bond);
            if (components_ == nullptr) continue;
            std::size_t const middle = std::min(line.find('|'), line.rfind('|'));
            auto const one = bead_of(line.substr(0, middle), line),
                       other = bead_of(line.substr(middle + 1), line);
            for (std::size_t way : {1, 2}) {
                bond.first = one[way - 1], bond.second = other[way - 1];
                bonds_[way].push_back(bond);
            }
        }
    }
    BondText numbers_of(std::string const& line) const {
        std::istringstream words(line.substr(line.rfind('|') + 1));
        std::array<std::string, 2> text;
        std::array<double, 2> value{};
        words >> text[0] >> text[1];
        for (std::size_t i = 0; i < 2; ++i)
            if (scene::parse_number(text[i], value[i]) != scene::NumberFault::none)
                refuse("the line holds no length and stiffness", line);
        return {value[0], value[1], 0, 0};
    }
    /// Particle of a bead: by the names, and as the package counts.
    std::array<std::int64_t, 2> bead_of(std::string const& words, std::string const& line) const {
        std::istringstream in(words);
        std::string name;
        std::int64_t molecule = 0, bead = 0;
        in >> name >> molecule >> bead;
        for (std::size_t c = 0; c < components_->all.size(); ++c) {
            auto const [first, beads, count] = (*molecules_)[c];
            if (!in || components_->all[c].name != name || molecule < 1 || bead < 1 ||
                molecule > static_cast<std::int64_t>(count) ||
                bead > static_cast<std::int64_t>(beads))
                continue;
            auto const within = (molecule - 1) * static_cast<std::int64_t>(beads) + bead - 1;
            std::size_t const counted =
                c == 0 ? 0 : (*molecules_)[c - 1].beads * (*molecules_)[c - 1].count;
            return {static_cast<std::int64_t>(first) + within,
                    static_cast<std::int64_t>(counted) + within};
        }
        refuse("the components have no such molecule or bead", line);
    }
    [[noreturn]] void refuse(char const* what, std::string const& line) const {
        throw InputError(fmt::format("{}: `{}`", what, scene::shown(line)),
                         fmt::format("{}: line {}", scene::shown_path(file_), number_), put_right);
    }

    std::string const& file_;
    CalvadosComponents const* components_ = nullptr;
    std::vector<Molecules> const* molecules_ = nullptr;
    std::size_t number_ = 0;
    std::array<std::vector<BondText>, 3> bonds_;  // by Numbering
};

/// True if both lists hold the same bonds in any order.
bool are_alike(std::vector<BondText> a, std::vector<BondText> b) {
    for (std::vector<BondText>* const list : {&a, &b}) {
        for (BondText& bond : *list)
            if (bond.first > bond.second) std::swap(bond.first, bond.second);
        std::sort(list->begin(), list->end(), [](BondText const& one, BondText const& other) {
            return std::tie(one.first, one.second, one.length, one.stiffness) <
                   std::tie(other.first, other.second, other.length, other.stiffness);
        });
    }
    return std::equal(
        a.begin(), a.end(), b.begin(), b.end(), [](BondText const& one, BondText const& other) {
            return one.first == other.first && one.second == other.second &&
                   are_equal(one.length, other.length) && are_equal(one.stiffness, other.stiffness);
        });
}

/// Returns the path as messages have it.
std::string text_of(fs::path const& path) { return scene::shown_path(path.string()); }

/// The files that a System was made of: copies in its folder, or files elsewhere.
class TableFiles {
  public:
    TableFiles(std::string folder, std::string system, std::vector<std::string>& notes)
        : folder_(std::move(folder)), system_(std::move(system)), notes_(notes) {}

    /// Calls `compare` with the file of that name: a copy in the folder, or where it is written. A
    /// refusal is a note, the first one alone, for a file elsewhere.
    template <class Compare>
    void use(char const* key, std::string const& written, Compare const& compare) {
        std::error_code ignored;
        fs::path const path = written, copy = fs::path(folder_) / path.filename(),
                       relative = fs::path(folder_) / path;
        bool const below = path.is_relative() && *path.lexically_normal().begin() != "..",
                   inside = fs::is_regular_file(copy, ignored) ||
                            (below && fs::is_regular_file(relative, ignored));
        fs::path const file = fs::is_regular_file(copy, ignored) ? copy : relative;
        if (!fs::is_regular_file(file, ignored)) {
            missing_.emplace(key, text_of(path));
            return;
        }
        if (inside) return compare(file.string());
        if (differing_.contains(file.string())) return;
        try {
            compare(file.string());
        } catch (InputError const& error) {
            differing_.insert(file.string());
            std::string const what = error.what();
            notes_.push_back(fmt::format("{}. The System is simulated as it is.",
                                         what.substr(0, what.find("): ") + 1)));
        }
    }

    /// Notes the files that are not there.
    void note_missing() const {
        if (missing_.empty()) return;
        std::vector<std::string> parts;
        for (auto const& [key, file] : missing_) parts.push_back(fmt::format("{} ({})", key, file));
        notes_.push_back(
            fmt::format("Not compared with {}, because the files are not there: {}. Copies in the "
                        "folder would be read.",
                        system_, fmt::join(parts, ", ")));
    }

  private:
    std::string folder_;
    std::string system_;  // name of the System's file
    std::vector<std::string>& notes_;
    /// Files that are not there, by their keys.
    std::map<std::string, std::string> missing_;
    /// Files elsewhere that were refused.
    std::set<std::string> differing_;
};

/// Throws InputError for restraints of a file, `asked`, that are not the System's bonds, `found`.
[[noreturn]] void refuse_restraints(std::string const& file, MadeSystem const& made,
                                    std::vector<BondText> const& asked,
                                    std::vector<BondText> const& found) {
    throw InputError(fmt::format("the {} custom restraints are not the {} bonds of the last "
                                 "force of bonds of {}",
                                 asked.size(), found.size(), made.name()),
                     text_of(file), put_right);
}

/// Returns the note for restraints that the package has numbered otherwise than by names.
std::string shifted_restraints(MadeSystem const& made, std::string const& file) {
    return fmt::format(
        "The custom restraints of {} join other molecules than {} names: for the third component "
        "and later ones the package counts the molecules of the preceding one alone. The System "
        "is simulated as it is.",
        made.name(), text_of(file));
}

/// Returns the bonds of the System's last force of the kind that has the custom restraints.
std::vector<BondText> last_bonds(MadeSystem const& made, bool go) {
    ForceText const* last = nullptr;
    for (ForceText const& force : made.text.forces())
        if (force.kind == (go ? "CustomBondForce" : "HarmonicBondForce")) last = &force;
    return last == nullptr ? std::vector<BondText>() : last->bonds;
}

/// Compares the System's last force of bonds with a file of custom restraints. Particles are
/// compared if there are components and their `molecules`.
void compare_restraints(std::string const& file, bool go, MadeSystem const& made,
                        CalvadosComponents const* components,
                        std::vector<Molecules> const& molecules, std::vector<std::string>& notes) {
    std::vector<BondText> const found = last_bonds(made, go);
    if (components != nullptr && !molecules.empty()) {
        RestraintFile const lines(file, *components, molecules);
        if (are_alike(lines.bonds(Numbering::of_names), found)) return;
        if (are_alike(lines.bonds(Numbering::of_package), found))
            return notes.push_back(shifted_restraints(made, file));
        refuse_restraints(file, made, lines.bonds(Numbering::of_names), found);
    }
    std::vector<BondText> const asked = RestraintFile(file).bonds(Numbering::none);
    std::vector<BondText> without = found;
    for (BondText& bond : without) bond.first = bond.second = 0;
    if (!are_alike(asked, without)) refuse_restraints(file, made, asked, found);
}

/// Compares chains with the sequences of FASTA files, each of which is read once.
class SequenceCheck {
  public:
    explicit SequenceCheck(MadeSystem const& made) : made_(made) {}

    /// Throws InputError unless the component's sequence in the file is that of the chain.
    void compare(CalvadosComponent const& component, ResidueTable const& table,
                 PdbChain const& chain, std::string const& file) {
        std::string const& sequence = sequence_in(file, component.name);
        std::size_t const beads = component.is_rna() ? calvados_rna::beads_a_nucleotide : 1;
        if (sequence.size() * beads != chain.size())
            throw InputError(
                fmt::format("`{}` has {} residues, and chain {} of {} has {}",
                            scene::shown(component.name), sequence.size(), scene::shown(chain.name),
                            made_.topology, chain.size() / beads),
                text_of(file), put_right);
        for (std::size_t k = 0; k < chain.size(); ++k) {
            char const letter = sequence[k / beads];
            ResidueType const* const type = table.find(letter);
            std::string const& name = chain.residue[k];
            bool const same = type && (beads == 1 ? type->name == name : name[0] == letter);
            if (!same)
                throw InputError(fmt::format("`{}` has {} as residue {}, and {} has {}",
                                             scene::shown(component.name), letter, k / beads + 1,
                                             made_.topology, scene::shown(name)),
                                 text_of(file), put_right);
        }
    }

  private:
    /// Returns a sequence in one-letter codes, without spaces.
    std::string const& sequence_in(std::string const& file, std::string const& record) {
        auto const [entry, is_new] = sequences_.try_emplace({file, record});
        if (is_new) {
            Node const at = named(file), name = named(record);
            entry->second = scene::read_fasta(file, at, {&name, nullptr});
            std::erase_if(entry->second, [](char c) { return c == '\n' || c == '\r' || c == ' '; });
        }
        return entry->second;
    }

    MadeSystem const& made_;
    /// Sequences by file and record.
    std::map<std::pair<std::string, std::string>, std::string> sequences_;
};

/// Type of bead k of a chain; nullptr if the table lacks it. The topology has nucleotides under
/// the letters of their bases, with the backbone first.
ResidueType const* type_of(CalvadosComponent const& component, ResidueTable const& table,
                           PdbChain const& chain, std::size_t k) {
    std::string const& name = chain.residue[k];
    if (!component.is_rna()) return table.find(name);
    return chain.place[k] == 0 ? table.find('p') : table.find(name.front());
}

/// Lengths of the first harmonic bonds of each particle to the particle before it and to the one
/// before that, nm; 0 without one. Restraints come later in the System.
std::array<std::vector<double>, 2> bonds_to_earlier(SystemText const& system,
                                                    std::size_t particles) {
    std::array<std::vector<double>, 2> lengths;
    for (std::vector<double>& each : lengths) each.assign(particles, 0);
    for (ForceText const& force : system.forces()) {
        if (force.kind != "HarmonicBondForce") continue;
        for (BondText const& bond : force.bonds) {
            std::int64_t const back = bond.second - bond.first;
            if ((back != 1 && back != 2) || bond.first < 0 ||
                bond.second >= static_cast<std::int64_t>(particles))
                continue;
            double& length =
                lengths[static_cast<std::size_t>(back - 1)][static_cast<std::size_t>(bond.second)];
            if (length == 0) length = bond.length;
        }
    }
    return lengths;
}

/// Compares the particles of chains with the tables of their components.
class TableCheck {
  public:
    TableCheck(PackageFile const& config, MadeSystem const& made, TableFiles& files)
        : made_(made),
          files_(files),
          contacts_(contacts_of(made.text)),
          masses_(made.text.masses()),
          to_earlier_(bonds_to_earlier(made.text, masses_.size())),
          sequences_(made) {
        if (config.find("pH") != nullptr) ph_ = config.number("pH", 7);
    }

    /// Compares the particles of each chain with the tables of its component.
    void compare_chains(CalvadosComponents const& components) {
        std::size_t first = 0;
        auto const owners = components.of_chains(made_.chains.size());
        for (std::size_t c = 0; c < owners.size(); ++c) {
            std::size_t const next = first + made_.chains[c].size();
            if (!owners[c]->residues.empty())
                files_.use("fresidues", owners[c]->residues, [&](std::string const& file) {
                    compare_chain(*owners[c], table_in(file), c, first);
                });
            first = next;
        }
    }

  private:
    struct Particle {
        std::size_t index;
        ResidueType const& type;
        std::string const& table;
    };

    ResidueTable const& table_in(std::string const& file) {
        auto const known = tables_.find(file);
        if (known != tables_.end()) return known->second;
        return tables_.emplace(file, read_residue_table(file, named(file))).first->second;
    }

    /// True if a particle begins (or ends) a chain of bonds.
    bool is_end(std::size_t p, bool is_border) const {
        return is_border || (made_.charges && !made_.charges->joined[p]);
    }

    void compare_chain(CalvadosComponent const& component, ResidueTable const& table, std::size_t c,
                       std::size_t first) {
        PdbChain const& chain = made_.chains[c];
        for (std::size_t k = 0; k < chain.size() && first + k < masses_.size(); ++k) {
            ResidueType const* const type = type_of(component, table, chain, k);
            if (type == nullptr)
                throw InputError(fmt::format("residue `{}` of {} is not in the table",
                                             scene::shown(chain.residue[k]), made_.topology),
                                 table.name(), put_right);
            std::size_t const p = first + k;
            bool const last = k + 1 == chain.size(), protein = component.is_protein();
            bool const n = protein && component.charges('N') && is_end(p, k == 0),
                       e = protein && component.charges('C') && (last || is_end(p + 1, false));
            double const mass = type->mass + (n ? calvados2::first_bead_mass : 0) +
                                (e ? calvados2::last_bead_mass : 0);
            refuse_unequal({p, *type, table.name()}, "a mass", masses_[p], mass, "amu");
            if (made_.charges && p < made_.charges->screening.charges.size())
                compare_charge({p, *type, table.name()}, n, e);
            if (contacts_ == nullptr || p >= contacts_->parameters.size()) continue;
            auto const& [sigma, lambda, id] = contacts_->parameters[p];
            refuse_unequal({p, *type, table.name()}, "a diameter", sigma, type->sigma, "nm");
            refuse_unequal({p, *type, table.name()}, "a stickiness", lambda, type->lambda, "");
            refuse_unequal({p, *type, table.name()}, "an `id`", id,
                           protein || component.is_rna() ? 1 : -1, "");
        }
        compare_bonds_of(component, table, chain, first);
        if (!component.sequences.empty() && !component.restrained)
            files_.use("ffasta", component.sequences, [&](std::string const& file) {
                sequences_.compare(component, table, chain, file);
            });
    }

    /// Compares the charge of a particle that is a charged N (`n`) or C (`c`) end, or neither. That
    /// of histidine needs a pH.
    void compare_charge(Particle const& particle, bool n, bool c) const {
        bool const histidine = particle.type.letter == 'H';
        if (histidine && !ph_) return;
        double const inner = histidine ? calvados2::histidine_charge(ph_) : particle.type.charge,
                     asked = inner + (n ? calvados2::first_bead_charge : 0) +
                             (c ? calvados2::last_bead_charge : 0),
                     found = made_.charges->screening.charges[particle.index];
        if (std::abs(found - asked) > most_charge)
            refuse_unequal(particle, "a charge", found, asked, "e");
    }

    void refuse_unequal(Particle const& particle, char const* what, double made, double asked,
                        char const* unit) const {
        if (are_equal(made, asked)) return;
        std::string const space = *unit == '\0' ? "" : " ";
        throw InputError(
            fmt::format("{} has {} of {:.9g}{}{}, and particle {} (from 0) of {} has {:.9g}{}{}",
                        particle.type.name, what, asked, space, unit, particle.index, made_.name(),
                        made, space, unit),
            particle.table, put_right);
    }

    /// Compares bonds of a chain with the mean of its residues' bonds, those of RNA with the
    /// outboard bead's. In a network's domains they have the structure's length, or one between
    /// both with Go contacts.
    void compare_bonds_of(CalvadosComponent const& component, ResidueTable const& table,
                          PdbChain const& chain, std::size_t first) const {
        bool const rna = component.is_rna();
        if (rna && component.restrained) return;
        for (std::size_t k = 1; k < chain.size() && first + k < masses_.size(); ++k) {
            bool const backbone = rna && chain.place[k] == 0;
            ResidueType const *const here = type_of(component, table, chain, k),
                                     *const before = type_of(component, table, chain, k - 1);
            double const made = to_earlier_[backbone ? 1 : 0][first + k];
            if (here == nullptr || before == nullptr || made == 0) continue;
            double const asked = rna ? here->bond : (here->bond + before->bond) / 2;
            if (component.restrained && is_of_structure(component, first + k, made, asked))
                continue;
            refuse_unequal({first + k, *here, table.name()},
                           component.restrained
                               ? "a bond to the preceding residue (outside of domains)"
                               : "a bond to the preceding residue",
                           made, asked, "nm");
        }
    }

    /// True if the bond of particle p to the preceding one may be the structure's, or if there is
    /// no structure to compare with.
    bool is_of_structure(CalvadosComponent const& component, std::size_t p, double made,
                         double of_table) const {
        auto const here = static_cast<std::int64_t>(p);
        auto const apart = made_.distance(here - 1, here);
        if (!apart || component.periodic) return true;
        if (std::abs(made - *apart) <= most_pdb_difference) return true;
        auto const [low, high] = std::minmax(*apart, of_table);
        return component.is_go() && made > low && made < high;
    }

    MadeSystem const& made_;
    TableFiles& files_;
    ForceText const* contacts_;
    std::vector<double> masses_;
    /// Lengths of bonds to the particle before and to the one before that, nm; 0 without one.
    std::array<std::vector<double>, 2> to_earlier_;
    std::optional<double> ph_;
    std::map<std::string, ResidueTable> tables_;
    SequenceCheck sequences_;
};

}  // namespace

void compare_tables(PackageFile const& config, CalvadosComponents const* components,
                    std::string const& folder, MadeSystem const& made,
                    std::vector<std::string>& notes) {
    TableFiles files(folder, made.name(), notes);
    TableCheck check(config, made, files);
    if (components != nullptr && components->comparable()) check.compare_chains(*components);
    if (config.truth("custom_restraints")) {
        bool const go = config.text("custom_restraint_type", "harmonic") == "go";
        auto const molecules =
            components == nullptr ? std::vector<Molecules>() : molecules_of(*components, made);
        files.use("fcustom_restraints", config.text("fcustom_restraints", "custom_restraints.txt"),
                  [&](std::string const& file) {
                      compare_restraints(file, go, made, components, molecules, notes);
                  });
    }
    files.note_missing();
}

}  // namespace catena::foreign
