// What a PDB file says about chains. No OpenMM here.
#pragma once

#include <string>
#include <vector>

#include "math/linear.hpp"

namespace catena {

struct PdbChain {
    std::string name;                  // letter, else segment, else number; unique: A, A-2, ...
    std::vector<std::string> residue;  // one an atom
    std::vector<Vec3> position;        // nm

    std::size_t size() const { return residue.size(); }
};

/// The chains of the first model, in the file's order: a new one begins after TER and where letter
/// or segment changes. Throws InputError; `where`: scene file and key, for messages. `notes`, where
/// it is given, takes what the file holds beyond that.
std::vector<PdbChain> read_pdb_topology(std::string const& file, std::string const& where,
                                        std::vector<std::string>* notes = nullptr);

}  // namespace catena
