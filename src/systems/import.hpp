// Chains from a serialised OpenMM System and its PDB topology: what a scene is made of that gives
// `system` and no chains.
#pragma once

#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/scene.hpp"
#include "systems/stiff_links.hpp"

namespace catena {

/// Arrays of one entry a bead.
struct ImportedChain {
    std::string name;
    std::vector<std::string> residue;  // three letters
    std::vector<double> mass;          // amu, the System's
    std::vector<Vec3> position;        // nm, as the PDB file rounds them
    std::vector<double> length;        // nm, of the link to the bead before; entry 0 is 0
};

struct ImportedSystem {
    std::vector<ImportedChain> chains;  // the topology's, in its order
    bool periodic = false;              // some force uses the box
    Vec3 box = Vec3::zero();            // edges of the System's box
    std::vector<std::string> notes;     // what was left out or is doubtful, a sentence each
    double largest_spread =
        0;  // of the soft springs that links stand for, relative to their length; 0: there are none
};

/// What the System says of chains that the scene writes down.
struct SystemLinks {
    bool periodic = false;             // some force uses the box
    std::vector<Joining> to_previous;  // by particle: what joins it to the one before
    std::vector<std::string> notes;    // what was left out, a sentence each
};

/// Particle order is topology order. Neighbours in a chain are joined by a link as long as the
/// harmonic bond or constraint between them. Throws InputError: unreadable files, different counts,
/// neighbours that nothing joins or a soft spring, and what Catena cannot drive (virtual sites,
/// barostats, ...). "built without OpenMM" where the build lacks it.
ImportedSystem import_openmm_system(OpenMmSpec const&, std::string const& scene_file);

/// Throws as import_openmm_system does, but not for neighbours.
SystemLinks read_system_links(OpenMmSpec const&, std::string const& scene_file);

/// "scene.yaml: forces.openmm.system"
inline std::string openmm_key(std::string const& scene_file, std::string const& key) {
    return scene_file + ": forces.openmm." + key;
}

}  // namespace catena
