// The message of a program that has no forces of OpenMM.
#pragma once

#include <string>

#include "error.hpp"

namespace catena {

/// Returns the error for a scene that needs OpenMM; `where` is its place. A program that is linked
/// with no_openmm.cpp defines it: built_without_openmm.cpp, or the Python package, which finds
/// OpenMM at run time.
InputError no_openmm(std::string const& where);

}  // namespace catena
