// Concentrations of the chains at a scene's start.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

/// Concentration of equal neighbouring chains of a scene, or of all its chains.
struct ChainConcentration {
    std::string chains;      // "p", "p-1 .. p-24", or "all chains"
    std::int64_t count = 0;  // number of chains
    /// "the box", or the part of it that the chains are in: "z from 65.02 to 84.98 nm".
    std::string where;
    double mg_per_ml = 0, mmol_per_l = 0;

    /// Returns for example "24 chains (p-1 .. p-24) in the box: 5 mg/ml, 0.38 mmol/l".
    std::string text() const;
};

/// Returns the concentration of each kind of chain in the periodic box. A second entry follows for
/// 20 chains or more that start in a part of the box only, such as a slab: the concentration
/// between the outermost beads. All chains together come last if there are several kinds. Empty
/// without a box, in SI units, and if no kind has several chains.
std::vector<ChainConcentration> concentrations_of(Scene const&);

}  // namespace catena
