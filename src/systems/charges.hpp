// Charges of beads in the CALVADOS models, and texts on them. This header does not need OpenMM.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "structure/calvados2.hpp"
#include "systems/bead_system.hpp"

namespace catena {

/// Returns the charge of each bead, e: that of its residue, with charged termini and the pH. Beads
/// of unknown residues have none.
std::vector<double> bead_charges(OpenMmSpec const&, ForceResidues const&, BeadSystem const&);

/// Returns what is assumed of histidine, e.g. "histidine neutral (no ph given), 2 of them". The
/// number is left out if there are none.
std::string histidine_text(OpenMmSpec const&, ForceResidues const&,
                           std::span<std::string const> residues);

/// True if a builder makes the scene's forces and a bead is charged.
bool has_charges(Scene const&);

/// Returns the net charges of the chains and, if there are any, what is assumed of histidines.
/// Empty unless a builder makes the scene's forces.
std::string assumed_charges(Scene const&);

/// Returns, e.g., "net charge: a -1.000 e, b 2.000 e; together 1.000 e". Consecutive chains of the
/// same charge are merged: "a to c -1.000 e each". `of_bead` holds the charges in e, in the order
/// of the beads.
std::string charge_text(std::span<double const> of_bead, BeadSystem const&);

}  // namespace catena
