// Removal of the bonds and constraints of a System that rigid links replace. Needs OpenMM's
// headers.
#pragma once

#include <OpenMM.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "systems/bead_system.hpp"
#include "systems/model.hpp"

namespace catena {

/// Lengths of the scene's links by the particles that they join.
class LinkTable {
  public:
    LinkTable(BeadSystem const& beads, std::vector<int> const& particle_of_bead);
    /// Returns the link's length, or nullptr if no link joins the particles.
    double const* length(int a, int b) const;

  private:
    std::map<std::pair<int, int>, double> lengths_;
};

/// Removes the constraints, which the scene's links replace, and returns a sentence on them. Throws
/// InputError for a constraint that is not a link of the same length.
std::vector<std::string> remove_constraints(OpenMM::System&, LinkTable const&,
                                            std::string const& where);

/// Names the forces after their terms. Then removes the bonds along links, and forces that have no
/// other term, and returns sentences on them. Bonds are those of HarmonicBondForces and of the
/// CustomBondForces that are named. Throws InputError for more forces than OpenMM has
/// groups.
std::vector<std::string> remove_linked_bonds(OpenMM::System&, LinkTable const&, NamedLinks const&,
                                             std::string const& where);

}  // namespace catena
