// Chains of a topology in a PDB or mmCIF file. This header does not need OpenMM.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "math/linear.hpp"

namespace catena {

/// One chain; arrays have one entry per atom.
struct PdbChain {
    /// Letter, else segment, else number of the chain; unique: A, A-2, ...
    std::string name;
    std::vector<std::string> residue;  // names of the residues
    std::vector<int> place;            // number of atoms of the residue before this one
    std::vector<Vec3> position;        // nm

    std::size_t size() const { return residue.size(); }
};

/// Returns the chains of the first model, in the file's order. A new chain begins after TER and at
/// a change of letter or segment. Throws InputError; `where` is the scene file and key in messages.
/// `notes`, unless nullptr, receives a sentence on further models, `cell` the edges of a
/// rectangular cell in nm, if the file has one.
std::vector<PdbChain> read_pdb_topology(std::string const& file, std::string const& where,
                                        std::vector<std::string>* notes = nullptr,
                                        std::optional<Vec3>* cell = nullptr);

}  // namespace catena
