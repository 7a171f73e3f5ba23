// Chains from a serialised OpenMM System and its PDB topology, for scenes with `system` and without
// `chains`.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/linear.hpp"
#include "scene/scene.hpp"
#include "systems/stiff_links.hpp"

namespace catena {

/// One chain of a topology; arrays have one entry per bead.
struct ImportedChain {
    /// Name of the chain in the topology.
    std::string name;
    std::vector<std::string> residue;  // three letters
    std::vector<int> place;            // in the residue, from 0
    std::vector<double> mass;          // amu, from the System
    std::vector<Vec3> position;        // nm, with the rounding of the PDB file
    /// Length of the link to the bead on which each bead hangs, nm; entry 0 is 0.
    std::vector<double> length;
    /// Inboard beads as in ChainSpec::parent; empty for an unbranched chain.
    std::vector<std::int64_t> parent = {};
    /// Constraints that close cycles of links.
    std::vector<CrossLink> crosslinks = {};
};

/// Screened Coulomb energy between unit charges: prefactor exp(-kappa r) / r.
struct Screening {
    double prefactor;  // kJ nm/mol
    double kappa;      // 1/nm, inverse Debye length
    /// Distance at which the energy is cut, nm; infinite without a cutoff.
    double cutoff = std::numeric_limits<double>::infinity();
    std::vector<double> charges = {};  // e, one per particle
};

/// All chains of a System with its box.
struct ImportedSystem {
    /// Chains of the topology, in its order.
    std::vector<ImportedChain> chains;
    /// True if at least one force uses the box.
    bool periodic = false;
    /// Edges of the System's box, nm.
    Vec3 box = Vec3::zero();
    /// Sentences on what was left out or is doubtful.
    std::vector<std::string> notes;
    /// Largest thermal spread of the soft springs that links replace, relative to their length; 0
    /// if there are none.
    double largest_spread = 0;
    /// Screening of the System's charges, if that is recognised.
    std::optional<Screening> screening;
};

/// A bonded force of a periodic System that does not use its box.
struct BoxlessForce {
    std::string name;
    /// Lowest and highest particle of each term.
    std::vector<std::pair<std::int64_t, std::int64_t>> spans;
};
/// Returns sentences on the forces that join chains. `first`: first particle of each chain, in
/// ascending order. Within a chain, which stays whole, the box makes no difference.
std::vector<std::string> notes_on_boxless(std::vector<BoxlessForce> const&,
                                          std::vector<std::int64_t> const& first);

/// The links of a System, for chains that the scene writes itself.
struct SystemLinks {
    /// True if at least one force uses the box.
    bool periodic = false;
    /// For each particle: the bonds and constraints to the preceding one.
    std::vector<Joining> to_previous;
    /// Harmonic bonds and constraints between particles that are not consecutive, by the lower and
    /// the higher particle.
    std::map<std::pair<std::int64_t, std::int64_t>, Joining> farther;
    /// Pairs that CustomBondForces and compounds of two particles bond, each with the lower
    /// particle first, in ascending order.
    std::vector<std::pair<std::int64_t, std::int64_t>> custom;
    std::vector<BoxlessForce> boxless;
    /// Sentences on what was left out.
    std::vector<std::string> notes;
    /// Screening of the System's charges, if that is recognised.
    std::optional<Screening> screening;
};

/// Imports the chains of the topology; particles and atoms have the same order. Each bead hangs on
/// an earlier one of its chain, by a link with the length of the harmonic bond or constraint
/// between them; a chain whose beads do not follow one another is branched. Constraints that close
/// a cycle of links become cross-links, bonds that do stay springs. Throws InputError for
/// unreadable files, different counts, and beads without a bond to an earlier one or with a soft
/// spring. Also refused are virtual sites, barostats and other parts that Catena cannot drive. A
/// build without OpenMM throws "built without OpenMM".
ImportedSystem import_openmm_system(OpenMmSpec const&, std::string const& scene_file);

/// Reads the links of a System. Throws like import_openmm_system(), but not for neighbours.
SystemLinks read_system_links(OpenMmSpec const&, std::string const& scene_file);

/// The particles of a System as chains by its bonds.
struct BondedChains {
    /// Number of particles of each chain: consecutive particles, each of which harmonic bonds,
    /// constraints or CustomBondForces join to an earlier one.
    std::vector<std::int64_t> sizes;
    std::vector<double> mass;  // amu, one per particle
    /// Edges of the box, nm, if a force uses it.
    std::optional<Vec3> box;
};
/// Finds the chains of the System that the spec names. Throws like import_openmm_system(); `name`
/// takes the place of the scene file in messages.
BondedChains chains_by_bonds(OpenMmSpec const&, std::string const& name);

/// Holds what is read of a serialised State.
struct OpenMmState {
    std::vector<Vec3> positions;  // nm
    Vec3 box = Vec3::zero();      // edges, nm
    bool has_velocities = false;
};
/// Reads a serialised State. Throws InputError for another file and for a State without positions;
/// `where` is the place in messages. A build without OpenMM throws "built without OpenMM".
OpenMmState read_openmm_state(std::string const& file, std::string const& where);

/// Screened charges of a System, and the particles that follow each other in a chain.
struct ScreenedChains {
    Screening screening;
    /// joined[p] is true if a bond or constraint joins particle p to the preceding one.
    std::vector<bool> joined;
};
/// Reads them off a serialised System; nothing if the screening is not recognised. Throws
/// InputError for a file that cannot be read; `where` is the place in messages. A build without
/// OpenMM throws "built without OpenMM".
std::optional<ScreenedChains> read_screened_chains(std::string const& file,
                                                   std::string const& where);

/// Names a key in messages: "scene.yaml: forces.openmm.system".
inline std::string openmm_key(std::string const& scene_file, std::string const& key) {
    return scene_file + ": forces.openmm." + key;
}

}  // namespace catena
