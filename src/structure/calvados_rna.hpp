// The CALVADOS model of disordered RNA: Yasuda, von Buelow, Tesei, Yamashiro & Lindorff-Larsen, J.
// Chem. Theory Comput. (2025). A nucleotide has two beads: the backbone, which is linked to the
// next nucleotide's backbone, and the base, which hangs on it. Masses, sizes and lengths are those
// of the built-in residue table "calvados_rna"; the other parameters are those of the CALVADOS
// package's examples single_RNA and slab_mixed. The model was fitted beside CALVADOS 2.
#pragma once

#include <string_view>

namespace catena::calvados_rna {

/// Name of the model in scenes and of its residue table.
inline constexpr std::string_view model = "calvados_rna";
/// Name of the residue of all beads of the backbone.
inline constexpr std::string_view backbone = "RBC";
/// Number of beads per nucleotide: the backbone, then the base.
inline constexpr int beads_a_nucleotide = 2;

/// Stiffness of the harmonic bonds that the links replace, kJ/mol/nm2: from backbone to backbone,
/// and from backbone to base.
inline constexpr double backbone_stiffness = 1400, base_stiffness = 2200;
/// Harmonic angle of three consecutive beads of the backbone: kJ/mol/rad2, rad.
inline constexpr double angle_stiffness = 4.20, rest_angle = 3.14;
/// Stacking of the bases of neighbours in the chain: an Ashbaugh-Hatch potential of this diameter,
/// nm, multiplied by this factor. It has the cutoff of the other contacts.
inline constexpr double stacking_diameter = 0.4, stacking_factor = 15;

}  // namespace catena::calvados_rna
