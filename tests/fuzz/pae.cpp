// Predicted aligned errors, for a structure of as many residues as the file has rows.
#include <cmath>

#include "domains/predicted_error.hpp"
#include "tests/fuzz/rigid.hpp"

void catena::fuzz::read(std::string_view bytes) {
    scene::PredictedError const error =
        scene::read_predicted_error(MemoryFile(bytes).path(), scene::Node());
    require(error.residues > 0 && error.value.size() == error.residues * error.residues);
    for (float const value : error.value) require(std::isfinite(value) && value >= 0);
    std::vector<std::optional<double>> plddt(error.residues, 90);
    for (std::size_t k = 0; k < plddt.size(); k += 5) plddt[k] = 40;
    read_rigid("pae", bytes, {{error.residues}, "TIA1", "scene.yaml", plddt}, ", min_length: 3");
}
