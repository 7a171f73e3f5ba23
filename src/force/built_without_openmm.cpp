// The message of a build without OpenMM.
#include "force/no_openmm.hpp"

namespace catena {

InputError no_openmm(std::string const& where) {
    return built_without("OpenMM", where,
                         "install OpenMM (pip install openmm, or Debian's libopenmm-dev) and build "
                         "again, or leave forces.openmm out");
}

}  // namespace catena
