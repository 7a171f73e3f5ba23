// Predicted aligned errors of a structure, in the JSON of the AlphaFold database and of ColabFold.
#pragma once

#include <string>
#include <vector>

#include "scene/node.hpp"

namespace catena::scene {

/// Predicted aligned error of each pair of residues: the mean of both directions, angstrom.
struct PredictedError {
    std::size_t residues = 0;
    std::vector<float> value;  // residues * residues

    double at(std::size_t i, std::size_t j) const { return value[i * residues + j]; }
};

/// Reads `[{"predicted_aligned_error": [[...], ...]}]` (AlphaFold database), the same map without
/// the list, or with the key `pae` (ColabFold, AlphaFold 3). Throws InputError for other contents,
/// for a matrix that is not square, for several matrices, and for errors outside of 0 to 1000.
PredictedError read_predicted_error(std::string const& path, Node const& at);

}  // namespace catena::scene
