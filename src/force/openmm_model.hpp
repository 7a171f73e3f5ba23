// The forces of a scene as one OpenMM System, whatever built it. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <memory>
#include <string>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena {

struct OpenMmModel {
    std::shared_ptr<OpenMM::System> system;  // force i in group i; nothing in it that a rigid link replaces
    std::vector<std::string> terms;          // names of the forces, all different
    std::vector<std::int64_t> bead_of_particle;
    std::vector<std::string> notes;  // for people: what the model is, what was left out
};

/// The particle of each bead.
inline std::vector<int> particles_of_beads(std::vector<std::int64_t> const& bead_of_particle) {
    std::vector<int> particle(bead_of_particle.size());
    for (std::size_t p = 0; p < particle.size(); ++p) particle[static_cast<std::size_t>(bead_of_particle[p])] = static_cast<int>(p);
    return particle;
}

/// The CALVADOS 2 model on every chain of beads. Two forces: ashbaugh-hatch and yukawa.
OpenMmModel calvados2_model(OpenMmSpec const&, BeadSystem const&);

/// A serialised System, its particles being the beads.
OpenMmModel system_model(OpenMmSpec const&, BeadSystem const&);

/// "CustomNonbondedForce".
std::string kind_of(OpenMM::Force const&);

/// The whole serialised System in `file`. `where`: scene file and key, for messages. Throws InputError with one line; for a System that
/// this OpenMM cannot read it names both versions.
std::unique_ptr<OpenMM::System> read_openmm_system(std::string const& file, std::string const& where);

/// Refuses what a simulation with rigid links driven by Catena cannot have: virtual sites, massless particles, and forces that move
/// particles (thermostats, barostats, removal of the centre of mass's motion), by name.
void refuse_movers(OpenMM::System const&, std::string const& where);

/// "scene.yaml: forces.openmm.system"
inline std::string openmm_key(std::string const& scene_file, std::string const& key) { return scene_file + ": forces.openmm." + key; }

}  // namespace catena
