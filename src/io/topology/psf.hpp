// Writer of topology.psf: masses and bonds, for which topology.pdb has no room, in the form that
// MDAnalysis and VMD read. Source of the format:
// https://www.ks.uiuc.edu/Research/vmd/current/devel.html, psfplugin; fields between blanks, marked
// NAMD.
#pragma once

#include "io/output.hpp"
#include "io/output_file.hpp"
#include "io/site_names.hpp"

namespace catena {

/// Writes the whole file: one line per site, in the units of the scene. Charges are 0, because the
/// force field's charges are not part of the topology.
void write_psf(AtomicFile& out, Topology const&, SiteNames const&);

}  // namespace catena
