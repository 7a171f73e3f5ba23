// Helices as atoms of a structure file: neighbours stand 3.83 angstrom apart, no three on a line.
#pragma once

#include <cmath>

#include "tests/reader/structure_text.hpp"

namespace catena::test {

/// A helix of glycines along x, from the residue of this number on; coordinates in angstrom.
inline std::vector<AtomLine> helix(int residues, std::string const& chain, int number = 1,
                                   double y = 0, double x = 0) {
    std::vector<AtomLine> atoms;
    for (int k = 0; k < residues; ++k) {
        double const turn = k * 1.745329;  // 100 degrees
        atoms.push_back({"CA", "GLY", chain, number + k, x + 1.5 * k, y + 2.3 * std::cos(turn),
                         2.3 * std::sin(turn)});
    }
    return atoms;
}

}  // namespace catena::test
