#include "structure/pdb_sites.hpp"
#include "tests/fuzz/target.hpp"

void catena::fuzz::read(std::string_view bytes) {
    for (bool const mass_centres : {false, true})
        scene::read_pdb(MemoryFile(bytes).path(), scene::Node(), {{}, {}, mass_centres});
}
