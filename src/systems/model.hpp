// The forces of a scene as one OpenMM System, whatever built it. For files that see OpenMM's
// headers.
#pragma once

#include <OpenMM.h>

#include <memory>
#include <string>
#include <vector>

#include "systems/bead_system.hpp"
#include "systems/import.hpp"

namespace catena {

struct OpenMmModel {
    std::shared_ptr<OpenMM::System>
        system;                      // force i in group i; nothing in it that a rigid link replaces
    std::vector<std::string> terms;  // names of the forces, all different
    std::vector<std::int64_t> bead_of_particle;
    std::vector<std::string> notes;  // for people: what the model is, what was left out
};

/// The particle of each bead.
inline std::vector<int> particles_of_beads(std::vector<std::int64_t> const& bead_of_particle) {
    std::vector<int> particle(bead_of_particle.size());
    for (std::size_t p = 0; p < particle.size(); ++p)
        particle[static_cast<std::size_t>(bead_of_particle[p])] = static_cast<int>(p);
    return particle;
}

/// The CALVADOS 2 model on every chain of beads. Two forces: ashbaugh-hatch and yukawa.
OpenMmModel calvados2_model(OpenMmSpec const&, BeadSystem const&);

/// A serialised System, its particles being the beads.
OpenMmModel system_model(OpenMmSpec const&, BeadSystem const&);

/// "CustomNonbondedForce".
std::string kind_of(OpenMM::Force const&);

/// Names of these forces of a System, all different and without characters that mean something in
/// tables, pages or terminals: those they bear; where these are OpenMM's own, yukawa and
/// ashbaugh-hatch by the expression, else the kind of the force.
std::vector<std::string> term_names(OpenMM::System const&, std::vector<int> const& forces);

/// The whole serialised System in `file`. `where`: scene file and key, for messages. Throws
/// InputError with one line; for a System that this OpenMM cannot read it names both versions.
std::unique_ptr<OpenMM::System> read_openmm_system(std::string const& file,
                                                   std::string const& where);

/// Takes what moves particles off a System, and says so in a sentence each: a CMMotionRemover, and
/// thermostats and barostats in groups that `groups` (empty: all) does not name. Refuses the
/// others, virtual sites and particles without a mass: throws InputError.
std::vector<std::string> leave_movers_out(OpenMM::System&, std::vector<int> const& groups,
                                          std::string const& where);

}  // namespace catena
