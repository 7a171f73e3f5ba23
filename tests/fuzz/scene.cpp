#include "scene/node.hpp"
#include "tests/fuzz/target.hpp"

void catena::fuzz::read(std::string_view bytes) {
    scene::parse_document(std::string(bytes), "scene.yaml");
}
