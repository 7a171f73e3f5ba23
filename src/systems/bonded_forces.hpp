// Copies of the bonded forces of OpenMM, filtered term by term. Needs OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>

namespace catena {

/// Decides on one bonded term and renumbers its particles.
class TermFilter {
  public:
    virtual ~TermFilter() = default;
    /// Returns true to keep the term; may change the particles' numbers in place.
    virtual bool keep(std::span<int* const> particles) = 0;
    bool keep(std::initializer_list<int*> particles) {
        return keep(std::span<int* const>(particles.begin(), particles.size()));
    }
    /// Calls `add` for each copy of the term to make, with the particles' numbers set: by default
    /// once if the term is kept.
    virtual void each(std::span<int* const> particles, std::function<void()> const& add) {
        if (keep(particles)) add();
    }
    void each(std::initializer_list<int*> particles, std::function<void()> const& add) {
        each(std::span<int* const>(particles.begin(), particles.size()), add);
    }
};

/// Returns a copy of a bonded force with the terms that the filter keeps. Returns nullptr for a
/// force that is not bonded or not of a common kind.
std::unique_ptr<OpenMM::Force> copy_bonded(OpenMM::Force const& from, TermFilter& filter);

}  // namespace catena
