#include "scene/files.hpp"
#include "tests/fuzz/target.hpp"

void catena::fuzz::read(std::string_view bytes) {
    scene::read_position_table(MemoryFile(bytes).path(), scene::Node());
}
