// A serialised System, through the scanner and OpenMM's own reader.
#include <OpenMM.h>

#include "systems/model.hpp"
#include "systems/plugins.hpp"
#include "tests/fuzz/plain_xml.hpp"
#include "tests/fuzz/target.hpp"

/// Reading needs no platform.
std::vector<std::string> const& catena::load_openmm_plugins() {
    static std::vector<std::string> const none;
    return none;
}

void catena::fuzz::read(std::string_view bytes) {
    auto const system = read_openmm_system(MemoryFile(bytes).path(), "scene.yaml: forces.system");
    std::vector<std::string> const forces = plain_forces(bytes);
    require(static_cast<std::size_t>(system->getNumForces()) == forces.size());
    for (int i = 0; i < system->getNumForces(); ++i)
        require(kind_of(system->getForce(i)) == forces[static_cast<std::size_t>(i)]);
}
