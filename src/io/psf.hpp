// topology.psf: what topology.pdb has no room for, masses and bonds, as MDAnalysis and VMD read
// them (https://www.ks.uiuc.edu/Research/vmd/current/devel.html, psfplugin: fields between blanks,
// marked NAMD).
#pragma once

#include <string>

#include "io/output.hpp"
#include "io/output_file.hpp"

namespace catena {

/// A, B, ..., Z, AA, AB, ...: chain names of any width.
std::string chain_name(std::size_t number);

/// As the formats hold it: three characters of printable ASCII at most, UNK where there is none.
std::string residue_of(Topology const&, std::size_t site);

/// The whole file: a line a site, in the units of the scene; charges are 0, for the force field's
/// are not the topology's.
void write_psf(AtomicFile& out, Topology const&);

}  // namespace catena
