// Gravity: every mass has the same acceleration.
#pragma once

#include "terms/force_term.hpp"

namespace catena::terms {

/// Bodies in joint coordinates fall with gravity: their ground accelerates by -g (JointLoads).
struct Gravity : ForceTerm {
    static constexpr char const* name = "gravity";
    static constexpr bool known_to_peers = true;
    static constexpr char const* energy = "gravity";
    static constexpr bool always_has_energy = true;
    static constexpr bool pushes = true;
    static constexpr char const* scene_key = "gravity";
    static constexpr PrintPlace print_place = PrintPlace::before_chains;
    static constexpr Section section = Section::forces;

    static std::int64_t count(Scene const& scene, ChainSpec const& chain) {
        return norm(scene.forces.gravity) == 0 ? 0 : static_cast<std::int64_t>(chain.size());
    }
    static void read(scene::Fields const& forces, ForceSpec& spec) {
        if (scene::Node const* const given = forces.find(scene_key))
            spec.gravity = scene::vector3(*given);
    }
    template <class Values>
    static void decide(Scene const& scene, Values& values) {
        add(values, "forces.gravity", vector_text(scene.forces.gravity));
    }
    template <class Print>
    static void print(Scene const& scene, Print& print) {
        print.add(scene.forces.gravity);
    }
    static std::string text(Scene const& scene) {
        return norm(scene.forces.gravity) > 0 ? "gravity " + vector_text(scene.forces.gravity) : "";
    }

    template <template <int> class F>
    struct Arrays {
        Vec3 gravity = Vec3::zero();  // W, nm/ps^2.
    };
    template <class To, class From, class Convert>
    static To converted(From const& from, Convert const&) {
        return {from.gravity};
    }
    template <class Maker, class To>
    static void collect(Maker const& maker, To& to) {
        to.gravity = maker.scene.forces.gravity;
    }
    template <class From>
    static double energy_of(From const& from, PlacedBody const& body) {
        return -body.mass * dot(from.gravity, body.centre);
    }
};

}  // namespace catena::terms
