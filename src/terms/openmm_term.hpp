// The forces of OpenMM on beads (src/force computes them).
#pragma once

#include "terms/force_term.hpp"

namespace catena::scene {
struct DecidingValue;
class Fingerprint;
}  // namespace catena::scene

namespace catena::terms {

/// The energies are terms of OpenMM's own, one per force of the System.
struct OpenMmTerm : ForceTerm {
    static constexpr char const* name = "openmm";
    static constexpr bool known_to_openmm = true;
    static constexpr char const* scene_key = "openmm";
    static constexpr PrintPlace print_place = PrintPlace::forces;
    static constexpr Section section = Section::forces;

    static std::int64_t count(Scene const& scene, ChainSpec const& chain) {
        return scene.forces.openmm ? static_cast<std::int64_t>(chain.bead_count()) : 0;
    }
    static void decide(Scene const&, std::vector<scene::DecidingValue>&);
    static void print(Scene const&, scene::Fingerprint&);
    /// For example "calvados2 at 300 K and 0.15 mol/l".
    static std::string text(Scene const&);
};

}  // namespace catena::terms
