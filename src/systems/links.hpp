// What a System's bonds and constraints make of neighbours in a chain. For files that see OpenMM's
// headers.
#pragma once

#include <OpenMM.h>

#include <string>
#include <unordered_map>
#include <vector>

#include "systems/stiff_links.hpp"

namespace catena {

/// Every pair of particles that harmonic bonds or constraints of a System hold together.
class Joinings {
  public:
    /// Throws InputError for bonds of negative or infinite stiffness. `where`: scene file and key.
    Joinings(OpenMM::System const&, std::string const& where);
    /// Of particle p and the one before; one that does not hold where nothing does.
    Joining to_previous(int p) const { return between(p - 1, p); }
    Joining between(int a, int b) const;
    /// Why the link between p - 1 and p in a chain that begins with particle `first` cannot be had:
    /// as an InputError with `at`.
    [[noreturn]] void refuse_gap(int p, int first, std::string const& at) const;

  private:
    std::string custom_bond(int a, int b) const;

    OpenMM::System const& system_;
    std::vector<std::unordered_map<int, Joining>> to_lower_;  // by the higher particle
};

}  // namespace catena
