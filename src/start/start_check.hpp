// Check of a scene's start by OpenMM's forces: energy, nearest beads, and whether a run can begin
// there.
#pragma once

#include <string>
#include <vector>

#include "force/openmm_force.hpp"
#include "integrate/chain_system.hpp"
#include "mpi/communicator.hpp"

namespace catena {

/// Forces of OpenMM on the beads at the start. Units are kJ/mol and nm.
struct StartForces {
    double energy = 0;       // potential energy of OpenMM's terms
    double thermal = 0;      // kinetic energy of all degrees of freedom at the forces' temperature
    double temperature = 0;  // temperature of the forces, K
    double largest_force = 0;  // kJ/mol/nm
    std::string force_at;      // "bead 21 of chain `p`"
    double nearest = -1;  // distance of the nearest beads that neither link nor body joins; among
                          // about equal distances those with the largest forces; -1: above 0.7 nm
    std::string nearest_pair;  // "beads 21 and 40 of chain `p`"

    /// True if potential energy exceeds ten times the thermal energy and a force exceeds any of
    /// thermal motion. Also true for a force too large for any step, and for values that are not
    /// finite.
    bool is_absurd() const;
    /// True if the energy is not finite though no force is too large for a step: positions are
    /// beyond the range of a force, and no relaxation brings them back.
    bool is_undefined() const;
    /// Text of one line with energy and largest force.
    std::string energy_text() const;
    /// Text of energy_text() and the nearest beads.
    std::string text() const;
};

/// Computes StartForces from forces on beads and their energy. `positions` and `forces` are in the
/// order of `beads`.
StartForces start_forces_of(Scene const&, BeadSystem const& beads,
                            std::vector<Vec3> const& positions, std::vector<Vec3> const& forces,
                            double energy);

/// Returns the forces of the system's last evaluation, which must have been at the scene's start
/// and with OpenMM. Ranks other than 0 receive default values. Throws InputError, which names the
/// nearest beads, if the start is absurd. Collective.
StartForces look_at_start(ChainSystem&);

/// Throws InputError if the forces at the start are absurd. `relaxation`: text about a preceding
/// relaxation, empty if there was none.
void refuse_absurd(Scene const&, StartForces const&, std::string const& relaxation = "");

/// Throws InputError if beads are so near that OpenMM's forces may not be finite and the start is
/// absurd. Throws it also if a System's forces are not finite because beads lie on a line, where
/// torsions are undefined. Rank 0 detects both before any collective computation. Without OpenMM's
/// forces the call does nothing. Collective.
void refuse_coinciding(Scene const&, Communicator const&);

}  // namespace catena
