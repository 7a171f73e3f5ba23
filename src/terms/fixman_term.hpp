// The Fixman potential of chains of beads (dynamics/fixman.hpp computes it).
#pragma once

#include "terms/force_term.hpp"

namespace catena::terms {

struct FixmanTerm : ForceTerm {
    static constexpr char const* name = "fixman";
    static constexpr bool known_to_openmm = true;
    static constexpr char const* energy = "fixman";
    static constexpr bool needs_matrices = true;
    static constexpr char const* unknown_to_oracles = "Fixman potential";
    static constexpr PrintPlace print_place = PrintPlace::after_dynamics;
    static constexpr Section section = Section::dynamics;

    static std::int64_t count(Scene const& scene, ChainSpec const& chain) {
        return scene.dynamics.fixman ? static_cast<std::int64_t>(chain.beads.size()) : 0;
    }
    template <class Values>
    static void decide(Scene const& scene, Values& values) {
        if (scene.dynamics.fixman) add(values, "dynamics.fixman", true);
    }
    template <class Print>
    static void print(Scene const& scene, Print& print) {
        add_named(print, "fixman", scene.dynamics.fixman);
    }
    static std::string dynamics_text(Scene const& scene);
    static std::string why_host_alone(Scene const& scene) {
        return scene.dynamics.fixman ? "the Fixman force is computed on the host" : "";
    }
};

}  // namespace catena::terms
