#include "structure/residue_table.hpp"
#include "tests/fuzz/target.hpp"

void catena::fuzz::read(std::string_view bytes) {
    parse_residue_table(std::string(bytes), "residues.csv");
}
