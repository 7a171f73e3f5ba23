// The bonded forces of OpenMM, term by term. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <initializer_list>
#include <memory>

namespace catena {

/// Decides about one bonded term and renumbers its particles.
class TermFilter {
  public:
    virtual ~TermFilter() = default;
    virtual bool keep(std::initializer_list<int*> particles) = 0;
};

/// A copy of a bonded force with the terms that the filter keeps; nullptr for a force that is not
/// bonded (or not one of the common kinds).
std::unique_ptr<OpenMM::Force> copy_bonded(OpenMM::Force const& from, TermFilter& filter);

}  // namespace catena
