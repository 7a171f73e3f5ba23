// The forces of a scene as one OpenMM System, for all sources of forces. Needs OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "systems/bead_system.hpp"
#include "systems/import.hpp"

namespace catena {

/// A System on the beads of a scene.
struct OpenMmModel {
    /// System with force i in group i. Bonds and constraints replaced by rigid links are removed.
    std::shared_ptr<OpenMM::System> system;
    std::vector<std::string> terms;  // names of the forces, all different
    /// Bead of each particle.
    std::vector<std::int64_t> bead_of_particle;
    /// Sentences for the user on the model and on what was left out.
    std::vector<std::string> notes;
};

/// Inverts the map: returns the particle of each bead.
inline std::vector<int> particles_of_beads(std::vector<std::int64_t> const& bead_of_particle) {
    std::vector<int> particle(bead_of_particle.size());
    for (std::size_t p = 0; p < particle.size(); ++p)
        particle[static_cast<std::size_t>(bead_of_particle[p])] = static_cast<int>(p);
    return particle;
}

/// Builds the CALVADOS model that the spec names on every chain of beads. It has two forces,
/// ashbaugh-hatch and yukawa; with RNA also stacking and backbone-angles.
OpenMmModel calvados2_model(OpenMmSpec const&, BeadSystem const&);

/// Builds the model from a serialised System whose particles are the beads.
OpenMmModel system_model(OpenMmSpec const&, BeadSystem const&);

/// Number of force groups that OpenMM distinguishes.
inline constexpr int force_groups_of_openmm = 32;

/// Class name of the force, e.g. "CustomNonbondedForce".
std::string kind_of(OpenMM::Force const&);

/// Name of a force in tables and messages: the user's, else yukawa or ashbaugh-hatch where the
/// expression is recognised, else its kind. Characters with a meaning in tables, pages or terminals
/// are replaced.
std::string shown_name(OpenMM::Force const&);

/// Names of the given forces of a System: those of shown_name(), numbered where they are equal.
std::vector<std::string> term_names(OpenMM::System const&, std::vector<int> const& forces);

/// Returns the particles' charges if the force has any: those of a NonbondedForce, or a parameter
/// named q, Q or charge.
std::vector<double> charges_of(OpenMM::Force const&);
/// Returns the screening of the first CustomNonbondedForce whose energy between two charges is
/// exp(-kappa r)/r times a prefactor; nothing if the System has none or no particle is charged.
std::optional<Screening> screening_of(OpenMM::System const&);

/// Reads the whole serialised System in `file`. `where` is the scene file and key in messages.
/// Throws InputError with one line; for a System that this OpenMM cannot read it names both
/// versions.
std::unique_ptr<OpenMM::System> read_openmm_system(std::string const& file,
                                                   std::string const& where);

/// Reads the serialised Force in `file`. Throws InputError like read_openmm_system().
std::unique_ptr<OpenMM::Force> read_openmm_force(std::string const& file, std::string const& where);

/// True if the name is the force's own, the one that `check` shows, or that of its kind.
bool is_named(OpenMM::Force const&, std::string const& name);
/// Links in the place of custom bonds: names or kinds of forces with lengths, nm
/// (ForceChanges::links).
using NamedLinks = std::vector<std::pair<std::string, double>>;
/// Length of the links that replace bonds of a CustomBondForce, nm; 0 for other forces.
double named_length(NamedLinks const&, OpenMM::Force const&);

/// Reads the scene's System without the forces that ForceChanges::leave_out names and without
/// movers. Appends sentences on these to `notes`. Throws InputError like read_openmm_system() and
/// leave_movers_out(), and for names of `leave_out` and `links` that the System does not have.
std::unique_ptr<OpenMM::System> read_scene_system(OpenMmSpec const&, std::string const& scene_file,
                                                  std::vector<std::string>& notes);

/// Removes forces that move particles and returns a sentence on each. Removable are
/// CMMotionRemovers, and thermostats and barostats in groups that `groups` (empty: all) does not
/// name. Throws InputError for other thermostats and barostats, virtual sites and particles without
/// a mass.
std::vector<std::string> leave_movers_out(OpenMM::System&, std::vector<int> const& groups,
                                          std::string const& where);

}  // namespace catena
