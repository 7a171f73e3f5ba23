// Residues of a structure file: gathered from its atoms, with their names for messages.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "scene/node.hpp"
#include "structure/pdb_file.hpp"
#include "structure/residue_names.hpp"

namespace catena::scene {

/// Atoms of one residue, in the file's order.
struct StructureResidue {
    std::vector<PdbAtom> atoms;
    ResidueMeaning meaning;

    PdbAtom const& front() const { return atoms.front(); }
    bool is_protein() const {
        return meaning.kind == ResidueKind::amino_acid || meaning.kind == ResidueKind::charged;
    }
};

/// Number of the atom's residue with its insertion code, "52A".
std::string label_of(PdbAtom const& atom);

/// Returns "ALA 7 of chain A", or the parts of it that the file gives.
std::string name_of(StructureResidue const& residue);

/// Returns "line 7" for a PDB file and "row 7 of _atom_site" for mmCIF.
std::string place_of(PdbAtom const& atom);

/// Gathers atoms into residues. Atoms of a residue need not be consecutive, because alternate
/// locations may form blocks of their own.
class ResidueGathering {
  public:
    /// `path` is the file and `at` the key in messages; both must outlive the object.
    ResidueGathering(std::string const& path, Node const& at) : path_(path), at_(at) {}

    /// Adds the next atom. Throws InputError for a residue that comes again under another name.
    void add(PdbAtom const& atom);

    std::vector<StructureResidue> residues;

  private:
    bool continues(PdbAtom const& atom) const;
    void add_to(StructureResidue& residue, PdbAtom const& atom);

    std::string const& path_;
    Node const& at_;
    std::map<std::tuple<int, std::string_view, std::string_view, int, std::int64_t, char>,
             std::size_t>
        known_;
    std::int64_t last_ = 0;
    /// Number of restarts of the residue numbers within the chain.
    int lap_ = 0;
};

}  // namespace catena::scene
