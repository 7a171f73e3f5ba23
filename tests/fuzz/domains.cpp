// Domain files of the CALVADOS package, for a chain without a structure; loops may become rigid.
#include "tests/fuzz/rigid.hpp"

void catena::fuzz::read(std::string_view bytes) {
    std::string const loop = bytes.size() % 2 == 0 ? "" : ", longest_loop: 7";
    read_rigid("domains", bytes, {{chain_residues}, "TIA1", "scene.yaml"}, loop);
}
