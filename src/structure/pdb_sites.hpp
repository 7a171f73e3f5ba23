// Selection of one site per residue from the atoms of a structure file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/node.hpp"
#include "structure/pdb_file.hpp"

namespace catena::scene {

/// The position that becomes a bead, with the residue's names.
struct PdbSite {
    Vec3 position;                       // nm
    std::string residue;                 // name in the file
    std::string label;                   // number with insertion code, "52A"
    std::optional<std::int64_t> number;  // none if unreadable
    /// Ends of the peptide bonds (atoms C and N), if the file has them, nm.
    std::optional<Vec3> carbonyl{}, nitrogen{};
    /// Position of the alpha carbon, which tells neighbours; the bead may be elsewhere, nm.
    Vec3 alpha = position;
    /// Position in the chain's sequence, from 1, if the file gives it.
    std::optional<std::int64_t> sequence_index{};
    /// B factor of the site's atom, or its pLDDT in a predicted structure.
    std::optional<double> b_factor{};
    /// True for a missing residue that was grown.
    bool grown = false;
};

/// Consecutive sites of one chain.
struct PdbSiteChain {
    std::string name;       // letter, `auth_asym_id` or segment; may be empty
    std::string label;      // `label_asym_id`; the letter in a PDB file
    std::size_t first = 0;  // range of sites [first, last)
    std::size_t last = 0;
    ListedSequence sequence{};  // empty if the file lists none
};

/// Sites of a file in its order.
struct PdbSites {
    std::string file;  // for messages
    std::vector<PdbSite> sites;
    std::vector<PdbSiteChain> chains{};
    /// Names of the file's other chains, which are not chosen, each once.
    std::vector<std::string> other_chains{};
    std::optional<Vec3> cell{};  // cell of the file, rectangular, nm
    /// Sentences on what was left out or chosen.
    std::vector<std::string> notes{};

    std::vector<Vec3> positions() const;
};

/// Part of a structure file that is read.
struct StructureChoice {
    /// Names of chains, as the authors gave them or `label_asym_id`; empty: all chains.
    std::vector<std::string> chains;
    /// Number of the model; the first without a value.
    std::optional<std::int64_t> model;
    /// True if beads stand at the residues' centres of mass, not at their alpha carbons.
    bool mass_centres = false;
};

/// Returns the alpha carbons of a PDB or mmCIF file. A file without alpha carbons must have one
/// atom per residue, and all atoms are returned. The alternate location of largest occupancy is
/// used, the first among equals. Water, ions and caps are left out with a note; so are other HETATM
/// residues next to a protein. Throws InputError for residues without a site or with two, and for
/// chains and models that the file lacks. Atoms of other chains are not looked at.
PdbSites read_pdb(std::string const& path, Node const& at, StructureChoice const& choice = {});

}  // namespace catena::scene
