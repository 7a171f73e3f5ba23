// Links between neighbours in a chain from a System's bonds and constraints. Needs OpenMM's
// headers.
#pragma once

#include <OpenMM.h>

#include <string>
#include <unordered_map>
#include <vector>

#include "systems/stiff_links.hpp"

namespace catena {

/// All pairs of particles that harmonic bonds or constraints of a System join.
class Joinings {
  public:
    /// Throws InputError for bonds of negative or infinite stiffness and for unknown particles.
    /// `where` is the scene file and key.
    Joinings(OpenMM::System const&, std::string const& where);
    /// Joining of particle p and the preceding one; it does not hold if nothing joins them.
    Joining to_previous(int p) const { return between(p - 1, p); }
    /// Joining of any two particles.
    Joining between(int a, int b) const;
    /// Throws the InputError for a missing link between p - 1 and p, in a chain that begins with
    /// particle `first`. The message names the reason and the place `at`.
    [[noreturn]] void refuse_gap(int p, int first, std::string const& at) const;

  private:
    /// Kind of a custom bond between two particles; empty if there is none.
    std::string custom_bond(int a, int b) const;

    OpenMM::System const& system_;
    std::vector<std::unordered_map<int, Joining>>
        to_lower_;  // key: higher particle, then lower one
};

}  // namespace catena
