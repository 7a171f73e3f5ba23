// Constraints that a System lacks while its Context is created.
#pragma once

#include <OpenMM.h>

#include <vector>

#include "plugin/constraint_chains.hpp"

namespace catena::plugin {

/// Constraints of a System, kept from OpenMM while a Context is created: OpenMM's preparation of
/// CCMA takes time that grows with the square of their number. Base of the integrators.
class HeldConstraints {
  public:
    virtual ~HeldConstraints() = default;
    /// Takes the constraints out of the System, except those left to SETTLE. Throws InputError if
    /// they are held already, if a force of the System reads constraints when a Context is created,
    /// and if OpenMM would refuse the constraints.
    void take(OpenMM::System& system);
    /// Puts the constraints back, in their order. Returns false if they are back already. Throws
    /// InputError if the System has got others meanwhile; it then has both.
    bool put_back(OpenMM::System& system);

  private:
    /// all_: all constraints of the System, while they are held; held_: those that it lacks; left_:
    /// number of those that it has.
    std::vector<Constraint> all_, held_;
    int left_ = 0;
};

/// Marks the constraints that OpenMM solves by SETTLE (rigid water): three particles with
/// constraints among themselves alone, two of them of one length.
std::vector<bool> left_to_settle(int particles, std::vector<Constraint> const& constraints);

/// The constraints of a System.
std::vector<Constraint> constraints_in(OpenMM::System const& system);

}  // namespace catena::plugin
