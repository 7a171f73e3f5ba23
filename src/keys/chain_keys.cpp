// Declares the keys of chains, their starts and their tips.
#include "keys/maps.hpp"

namespace catena::scene::keys {
namespace {

constexpr Key chain_keys[] = {
    {"name", "text", "`chain-1`, `chain-2`, ...", "",
     "The chain has this unique name; its copies have -1, -2 and so on behind it.", "name: asyn"},
    {"count", "integer >= 1", "1", "", "The entry stands for this number of copies.", "count: 20"},
    {"concentration", "number with unit", "none", "",
     "The number of copies is what gives this concentration in the chain's `place`, else in the "
     "box; units as in `box.cubic`.",
     "concentration: 0.4 mmol/l"},
    {"place", "map", "that of the scene", "", "This chain starts in a place of its own.",
     "place: {region: {from: [0, 0, 0], to: [20, 20, 10]}}"},
    {"sequence", "text", "none", "",
     "The chain has a bead for each of these one-letter codes, RNA has two; blanks are ignored.",
     "sequence: MDVFMKGLSK"},
    {"fasta", "path", "none", "", "The sequence is a record of this FASTA file.",
     "fasta: asyn.fasta"},
    {"record", "text or integer", "the record named as the chain, else the only one", "",
     "This record of `fasta` counts: its name, a part of it between bars, or its number from 1.",
     "record: P37840"},
    {"pdb", "path", "none", "", "Residues and start positions are those of this PDB or mmCIF file.",
     "pdb: 1ubq.cif"},
    {"chain", "text, list of texts, or `all`", "the only chain", "",
     "The chain of `pdb` with this name is read; a list or `all` makes several chains.",
     "chain: A"},
    {"conformer", "integer >= 0", "the first", "", "The model of `pdb` with this number is read.",
     "conformer: 3"},
    {"gaps", "`refuse`, `split`, `model`", "`refuse`", "",
     "Gaps of `pdb` are refused, end the chain, or are filled by grown residues.", "gaps: model"},
    {"sites", "`ca`, `com`", "`ca`", "",
     "Beads of `pdb` stand at the CA atoms or at the residues' centres of mass.", "sites: com"},
    {"bodies", "list of maps, or `{hdf5: path}`", "none", "",
     "The chain has these bodies, one by one.", "bodies: {hdf5: chain.h5}"},
    {"generator", "map with one key", "none", "", "A generator makes the chain from a few numbers.",
     "generator: {pendulum: {links: 8}}"},
    {"model", "`calvados2`, `calvados3`, `calvados_rna`, or a map",
     "required with `sequence`, `fasta`, `pdb`", "",
     "Beads and links have the masses, lengths and force parameters of this residue table.",
     "model: calvados2"},
    {"positions", "path", "none", "length; PDB, mmCIF: angstrom",
     "A sequence or a `freely_jointed` or `worm_like` chain starts from this table of lines "
     "`x,y,z`, or PDB or mmCIF file.",
     "positions: start.csv"},
    {"links", "`model`, `as_given`", "`model`", "",
     "Links have the model's lengths, or each the length that it has in the positions.",
     "links: as_given"},
    {"base", "`free`, `fixed`", "`free`; `fixed` for `pendulum`, `coil`, `dill`", "",
     "With `fixed`, joint 1 connects body 1 to the ground; with `free` there is no joint 1.",
     "base: fixed"},
    {"tip", "`free`, `fixed`, `ring`, or a map", "`free`", "",
     "The last body is free, or joined to the ground or to the first body.", "tip: fixed"},
    {"crosslinks", "list of lists", "none", "length",
     "Rigid links join these pairs of point beads, counted from 1, with the length that follows, "
     "else with their distance at the start.",
     "crosslinks: [[3, 9], [1, 12, 0.5]]"},
    {"loops", "list of maps", "none", "",
     "These joints close loops of rigid bodies, beside the bodies' own joints.",
     "loops: [{bodies: [2, 5], joint: {type: spherical}}]"},
    {"anchor", "3 numbers", "`[0, 0, 0]`", "length",
     "The first link of a chain on a fixed base begins at this point of the ground.",
     "anchor: [0, 0, 10]"},
    {"conformation", "`extended`, `self_avoiding`, or `{pdb: path}`", "`extended`", "",
     "A sequence without `positions` starts as a zig-zag, as a random walk that avoids itself, or "
     "from a PDB file.",
     "conformation: self_avoiding"},
    {"rigid", "list of ranges, or a map", "none", "",
     "The residues of each range, or of each list of ranges, become one rigid body.",
     "rigid: [\"A:1-34\", [47, 80]]"},
    {"charge_termini", "`both`, `N`, `C`, `none`", "`forces.openmm.charge_termini`", "",
     "These ends are free termini: N adds +1 e and 2 amu, C adds -1 e and 16 amu.",
     "charge_termini: none"},
    {"velocities", "`thermal`, `zero`", "as given, else thermal if a temperature is named", "",
     "The chain starts with thermal velocities or at rest.", "velocities: zero"},
};

constexpr Key conformation_keys[] = {
    {"pdb", "path", "required", "", "The chain starts from the positions of this PDB file.",
     "pdb: start.pdb"},
};

constexpr Key rigid_keys[] = {
    {"domains", "path", "required without `pae`", "",
     "The domains are those of this file of the CALVADOS package.", "domains: domains.yaml"},
    {"protein", "text", "the one named as the chain, else the only one", "",
     "The domains of this protein of the file count.", "protein: TIA1"},
    {"pae", "path", "required without `domains`", "",
     "The domains follow from this JSON file of predicted aligned errors and from the B factors of "
     "`pdb`.",
     "pae: AF-P12345-predicted_aligned_error.json"},
    {"plddt", "number, 0 to 100", "70", "", "Residues of a lower pLDDT belong to no domain.",
     "plddt: 80"},
    {"max_pae", "number > 0", "5", "angstrom",
     "Two parts of a domain have this mean error at most.", "max_pae: 8"},
    {"min_length", "integer >= 3", "20", "", "Segments with fewer residues stay flexible.",
     "min_length: 30"},
    {"longest_loop", "integer >= 0", "10 with `pae`, 0 with `domains`", "",
     "Up to this number of residues between two segments of one domain become part of it.",
     "longest_loop: 40"},
};

constexpr Key tip_keys[] = {
    {"joint", "map", "required without `ring`", "",
     "This joint connects the last body to the ground.",
     "joint: {type: spherical, translation: [1, 0, 0]}"},
    {"ring", "map", "required without `joint`", "",
     "This joint connects the last body to the first.",
     "ring: {type: spherical, translation: [1, 0, 0]}"},
};

constexpr std::string_view any_but_free =
    "`revolute`, `planar`, `universal`, `spherical`, `prismatic`, `helical`, `cylindrical`, "
    "`planar3`, `weld`, `link`";
constexpr Key tip_type{"type",
                       any_but_free,
                       "required",
                       "",
                       "The joint leaves the motions of this type free.",
                       "type: spherical"};
constexpr Key tip_axis{"axis",
                       "3 numbers, not all 0",
                       "required by `revolute`, `planar`, `prismatic`, `helical`, `cylindrical`",
                       "",
                       "The joint's axis has this direction.",
                       "axis: [0, 0, 1]"};
constexpr Key tip_axes{"axes",
                       "2 axes",
                       "required by `universal`, `planar3`",
                       "",
                       "The joint has these two axes, as a joint between bodies.",
                       "axes: [[1, 0, 0], [0, 1, 0]]"};
constexpr Key tip_pitch{"pitch",
                        "number, not 0",
                        "required by `helical`",
                        "length / radian",
                        "The joint shifts by this much per radian.",
                        "pitch: 0.1"};
constexpr Key tip_length{
    "length",      "number > 0", "as the start has it", "length", "A link at the tip is this long.",
    "length: 0.38"};

constexpr Key tip_q{"q",
                    "as `q` of a joint",
                    "0; identity",
                    "as of a joint",
                    "The joint stands at this position at the start.",
                    "q: 0.3"};

constexpr Key tip_joint_keys[] = {
    tip_type,
    tip_axis,
    tip_axes,
    tip_pitch,
    {"rotation", "3 rows of 3 numbers", "identity", "",
     "This rotation matrix is the orientation of the joint's frame J in the last body."},
    {"translation", "3 numbers", "`[0, 0, 0]`", "length",
     "J has its origin here in the last body; a link starts here.", "translation: [1, 0, 0]"},
    tip_q,
    {"anchor", "3 numbers", "where the start puts it; required by `link`", "length",
     "The ground's frame has its origin at this point of W.", "anchor: [2, 0, 0]"},
    tip_length,
};

constexpr Key loop_keys[] = {
    {"bodies", "2 whole numbers >= 0", "required", "",
     "The joint connects the first of these bodies, counted from 1, to the second; 0 is the "
     "ground.",
     "bodies: [5, 0]"},
    {"joint", "map", "required", "", "This joint closes the loop.",
     "joint: {type: spherical, translation: [1, 0, 0]}"},
    {"end", "3 numbers", "where the start puts it", "length",
     "The joint's frame has its origin here in the second body; a loop that is open there is "
     "refused.",
     "end: [0.5, 0, 0]"},
};

constexpr Key loop_joint_keys[] = {
    {"type",
     "`revolute`, `universal`, `spherical`, `prismatic`, `helical`, `cylindrical`, `planar3`, "
     "`weld`",
     "required", "", "The joint leaves the motions of this type free.", "type: spherical"},
    tip_axis,
    tip_axes,
    tip_pitch,
    {"rotation", "3 rows of 3 numbers", "identity", "",
     "This rotation matrix is the orientation of the joint's frame J in the first body."},
    {"translation", "3 numbers", "`[0, 0, 0]`", "length",
     "J has its origin here in the first body.", "translation: [1, 0, 0]"},
    tip_q,
};

constexpr Key ring_keys[] = {
    tip_type,
    tip_axis,
    tip_axes,
    tip_pitch,
    {"rotation", "3 rows of 3 numbers", "where the first body stands at the start", "",
     "This rotation matrix is the orientation of the joint's frame J in the last body."},
    {"translation", "3 numbers", "required but for `link`", "length",
     "The first body's origin is here in the last body.", "translation: [1, 0, 0]"},
    tip_length,
};

}  // namespace

constinit KeyMap const chain{"chains", "chains[i]", chain_keys};
constexpr Key model_keys[] = {
    {"residues", "path", "required", "",
     "The chain has this table of residues, with the columns of the CALVADOS package.",
     "residues: residues.csv"},
};
constinit KeyMap const model{"chains.model", "chains[i].model", model_keys};
constinit KeyMap const conformation{"chains.conformation", "chains[i].conformation",
                                    conformation_keys};
constinit KeyMap const rigid{"chains.rigid", "chains[i].rigid", rigid_keys};
constinit KeyMap const tip{"tip", "chains[i].tip", tip_keys};
constinit KeyMap const tip_joint{"tip.joint", "chains[i].tip.joint", tip_joint_keys};
constinit KeyMap const loop{"loops", "chains[i].loops[l]", loop_keys};
constinit KeyMap const loop_joint{"loops.joint", "chains[i].loops[l].joint", loop_joint_keys};
constinit KeyMap const tip_ring{"tip.ring", "chains[i].tip.ring", ring_keys};

}  // namespace catena::scene::keys
