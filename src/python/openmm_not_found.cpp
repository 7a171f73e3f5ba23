// The message of the module that the package loads where OpenMM is not found.
#include "force/no_openmm.hpp"

namespace catena {

InputError no_openmm(std::string const& where) {
    return {"OpenMM " CATENA_OPENMM_SERIES " was not found", where,
            "install it (pip install 'openmm==" CATENA_OPENMM_SERIES
            ".*') and start Python again, or leave forces.openmm out"};
}

}  // namespace catena
