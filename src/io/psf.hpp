// Writer of topology.psf: masses and bonds, for which topology.pdb has no room, in the form that
// MDAnalysis and VMD read. Source of the format:
// https://www.ks.uiuc.edu/Research/vmd/current/devel.html, psfplugin; fields between blanks, marked
// NAMD.
#pragma once

#include <string>

#include "io/output.hpp"
#include "io/output_file.hpp"

namespace catena {

/// Returns the chain name A, B, ..., Z, AA, AB, ..., of any length.
std::string chain_name(std::size_t number);

/// Residue name of a site in the form that the formats hold: at most three characters of printable
/// ASCII. UNK if the site has no name.
std::string residue_of(Topology const&, std::size_t site);

/// Writes the whole file: one line per site, in the units of the scene. Charges are 0, because the
/// force field's charges are not part of the topology.
void write_psf(AtomicFile& out, Topology const&);

}  // namespace catena
