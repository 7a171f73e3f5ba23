// OpenMM's vectors and errors beside Catena's.
#pragma once

#include <OpenMM.h>

#include <span>
#include <string>
#include <vector>

#include "error.hpp"
#include "math/linear.hpp"

namespace catena::plugin {

static_assert(sizeof(OpenMM::Vec3) == sizeof(Vec3));

/// Returns the numbers as Catena's vectors.
inline std::span<Vec3> as_span(std::vector<OpenMM::Vec3>& vectors) {
    return {reinterpret_cast<Vec3*>(vectors.data()), vectors.size()};
}

/// Runs `action`. A ComputationError becomes an OpenMMException with the integrator's name.
template <class Action>
void as_openmm_error(std::string const& user, Action const& action) {
    try {
        action();
    } catch (ComputationError const& error) {
        throw OpenMM::OpenMMException(user + ": " + error.what());
    }
}

}  // namespace catena::plugin
