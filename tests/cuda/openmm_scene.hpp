// Scenes of beads on which OpenMM's CUDA platform computes.
#pragma once

#include <string>

namespace catena::test {

/// `chains` in YAML, SEQ for a sequence of 71 residues; `openmm`: more of its keys.
inline std::string openmm_scene(std::string chains, std::string const& rest,
                                std::string const& openmm = "") {
    char const* const sequence =
        "MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHGVATVAEKTKEQVTNVGGAVV";
    for (std::size_t at; (at = chains.find("SEQ")) != std::string::npos;)
        chains.replace(at, 3, sequence);
    return "chains: [" + chains + "]\n" + rest +
           "\nforces: {gravity: [0, 0, -1], openmm: {builder: calvados2, platform: CUDA" + openmm +
           "}}\ndynamics: {integrator: g-baoab, step: 0.01, steps: 10, friction: 0.1, seed: 3}\n";
}

}  // namespace catena::test
