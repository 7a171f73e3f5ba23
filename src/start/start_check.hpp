// What OpenMM's forces make of a scene's start: its energy, its nearest beads, and whether it can
// be begun from.
#pragma once

#include <string>
#include <vector>

#include "force/openmm_force.hpp"
#include "integrate/chain_system.hpp"
#include "mpi/communicator.hpp"

namespace catena {

/// Of beads; kJ/mol, nm.
struct StartForces {
    double energy = 0;       // potential, of OpenMM's terms
    double thermal = 0;      // kinetic energy of all degrees of freedom at the forces' temperature
    double temperature = 0;  // K
    double largest_force = 0;  // kJ/mol/nm
    std::string force_at;      // "bead 21 of chain `p`"
    double nearest = -1;       // of beads that no link or body joins, those that feel most of the
                               // nearest; -1: further apart than 0.7 nm
    std::string nearest_pair;  // "beads 21 and 40 of chain `p`"

    /// More potential energy than thermal motion has, ten times over, and a force that no thermal
    /// motion meets; or a force that throws a bead out of any step. What is not finite is absurd.
    bool is_absurd() const;
    /// Energy and largest force in one line.
    std::string energy_text() const;
    /// The same with the nearest beads.
    std::string text() const;
};

/// The same from forces on beads and their energy. `positions`, `forces`: in the order of `beads`.
StartForces start_forces_of(Scene const&, BeadSystem const& beads,
                            std::vector<Vec3> const& positions, std::vector<Vec3> const& forces,
                            double energy);

/// Of the system's last evaluation, which was of the scene's start. With OpenMM. On rank 0, of the
/// others `energy` and `thermal` alone. InputError, which names the nearest beads, where the start
/// is absurd. Collective.
StartForces look_at_start(ChainSystem&);

/// InputError where forces at the start are absurd. `relaxation`: what relaxation did before, in
/// words; empty: there was none.
void refuse_absurd(Scene const&, StartForces const&, std::string const& relaxation = "");

/// InputError where beads so near that OpenMM's forces may not be finite make the start absurd, and
/// where a System's forces are not finite on beads that lie on a line, as torsions are: found by
/// rank 0 before anything is computed with others. Nothing without OpenMM's forces. Collective.
void refuse_coinciding(Scene const&, Communicator const&);

}  // namespace catena
