// Systems that hold every kind of force that can be split over ranks.
#pragma once

#include <OpenMM.h>

#include <memory>
#include <string>

#include "force/openmm_force.hpp"

namespace catena::testing {

/// Harmonic bonds, angles and torsions of every kind along and across the chains, an external
/// force, two pair forces with cutoffs (one with exceptions, offsets and a switch, one with a
/// tabulated function) and interaction groups. Periodic if the beads have a box.
std::unique_ptr<OpenMM::System> every_force(BeadSystem const& beads);

/// The particles alone.
std::unique_ptr<OpenMM::System> bare_system(BeadSystem const& beads);

std::string xml_of(OpenMM::System const& system);
std::string xml_of(OpenMM::Force const& force);

}  // namespace catena::testing
