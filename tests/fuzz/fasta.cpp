#include "structure/fasta.hpp"
#include "tests/fuzz/target.hpp"

void catena::Scene::note(std::string) {}  // of sequences in scenes, which are not read here

void catena::fuzz::read(std::string_view bytes) {
    scene::read_fasta(MemoryFile(bytes).path(), scene::Node(), {});
}
