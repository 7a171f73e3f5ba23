// The model of a chain of residues: its table, its ends, and what the scene's forces learn of them.
#pragma once

#include <vector>

#include "reader/chain_request.hpp"
#include "structure/residue_table.hpp"

namespace catena::scene {

/// Residue types of a chain, from the table of its request.
using Residues = std::vector<ResidueType const*>;

/// Returns the table that the chain's `model` names: one of the program, or a file. A file is read
/// for the first copy only. Throws InputError for unknown names and faulty files.
ResidueTable const& table_of(ChainRequest& request);

/// Names the chain's own table to the scene's builder of forces if the builder lacks one of the
/// residues or has other parameters for it. Throws InputError if the builder has another model.
/// Notes phosphates whose charge does not belong to the scene's pH.
void hand_to_forces(ChainRequest const& request, Residues const& residues);

/// Says which ends of the chain are termini of a protein, as far as `charge_termini` does not: ends
/// that are no amino acids have neither charge nor mass of a terminus, which a note says.
void find_ends(ChainRequest& request, Residues const& residues);

/// Lengths of the links, nm: entry k is the mean of the bonds of residues k - 1 and k. Entry 0, the
/// link to an anchor, is the bond of the first residue.
std::vector<double> link_lengths(Residues const& residues);

/// Throws InputError for the first of a chain's residues that the forces do not know, or that they
/// take from another table with other parameters than the chain's. `chain` is the chain's entry.
void check_residues(Node const& chain, std::vector<std::string> const& residues, Scene const& scene,
                    ForceResidues const& forces);

}  // namespace catena::scene
