// Viscous drag on rigid bodies.
#pragma once

#include "keys/maps.hpp"
#include "terms/force_term.hpp"

namespace catena::terms {

/// Force -linear v at the centre of mass and torque -angular omega.
struct Drag : ForceTerm {
    static constexpr char const* name = "drag";
    static constexpr bool does_work = true;
    static constexpr bool depends_on_velocities = true;
    static constexpr bool uses_positions = true;
    static constexpr bool exerts_forces = true;
    static constexpr bool on_links = false;
    static constexpr char const* in_messages = "drag";
    static constexpr char const* in_check = "drag";
    static constexpr char const* body_key = "drag";
    static constexpr char const* scene_key = "drag";
    static constexpr PrintPlace print_place = PrintPlace::before_dynamics;
    static constexpr Section section = Section::forces;

    /// True if bodies without drag of their own have drag.
    static bool is_everywhere(ForceSpec const& forces) {
        return forces.linear_drag != 0 || forces.angular_drag != 0;
    }
    static bool acts_on(ChainSpec const& chain, std::size_t k) {
        std::vector<std::array<double, 2>> const& drag = chain.bodies.drag;
        return !drag.empty() && (drag[k][0] != 0 || drag[k][1] != 0);
    }
    static std::int64_t count(Scene const& scene, ChainSpec const& chain) {
        if (chain.bodies.drag.empty())
            return is_everywhere(scene.forces) ? static_cast<std::int64_t>(chain.bodies.size()) : 0;
        std::int64_t count = 0;
        for (std::size_t k = 0; k < chain.bodies.drag.size(); ++k) count += acts_on(chain, k);
        return count;
    }
    /// Reads `drag: {linear, angular}`; both default to 0.
    static std::array<double, 2> read_map(scene::Node const& drag) {
        scene::Fields const parts(drag, scene::keys::drag);
        scene::Node const* const linear = parts.find("linear");
        scene::Node const* const angular = parts.find("angular");
        return {linear ? scene::non_negative(*linear) : 0,
                angular ? scene::non_negative(*angular) : 0};
    }
    static void read(scene::Fields const& forces, ForceSpec& spec) {
        scene::Node const* const given = forces.find(scene_key);
        if (!given) return;
        auto const [linear, angular] = read_map(*given);
        spec.linear_drag = linear, spec.angular_drag = angular;
    }
    static void read_body(scene::Node const& body, std::size_t k, ForceSpec const& forces,
                          ChainSpec& chain) {
        if (scene::Node const* const given = body.find(body_key))
            set_entry(chain.bodies.drag, k, chain.size(), read_map(*given),
                      {forces.linear_drag, forces.angular_drag});
    }
    template <class Use>
    static void columns(Use const& use) {
        use(Column<std::array<double, 2>>{&BodyArrays::drag, 5, "drag"});
    }
    template <class Table>
    static void read_table(Table& table, ChainSpec& chain) {
        table.rows("drag", 2, chain.bodies.drag, [&](std::size_t k, double const* v) {
            if (!(v[0] >= 0 && v[1] >= 0)) table.refuse_negative("drag", k, {v, 2});
            return std::array<double, 2>{v[0], v[1]};
        });
    }
    template <class Values>
    static void decide(Scene const& scene, Values& values) {
        add(values, "forces.drag.linear", scene.forces.linear_drag);
        add(values, "forces.drag.angular", scene.forces.angular_drag);
    }
    template <class Print>
    static void print(Scene const& scene, Print& print) {
        ForceSpec const& f = scene.forces;
        add_named(print, "scene drag", is_everywhere(f), f.linear_drag, f.angular_drag);
    }
    static std::string text(Scene const& scene) {
        return is_everywhere(scene.forces) ? "drag" : "";
    }
    static void put(Scene& scene, std::size_t) { scene.forces.linear_drag = 1e-6; }

    template <template <int> class F>
    struct Arrays {
        F<2> drag;  // {linear, angular}: amu/ps and amu nm^2/ps.
        bool dragged = false;
    };
    template <class To, class From, class Convert>
    static To converted(From const& from, Convert const& convert) {
        return {convert(from.drag), from.dragged};
    }
    template <class Maker, class To>
    static void collect(Maker const& maker, To& to) {
        to.dragged = maker.template any<Drag>();
        if (!to.dragged) return;
        ForceSpec const& f = maker.scene.forces;
        to.drag = maker.template field<2>([&f](ChainSpec const& c, std::size_t k) {
            std::vector<std::array<double, 2>> const& own = c.bodies.drag;
            return own.empty() ? Vector<double, 2>{{f.linear_drag, f.angular_drag}}
                               : Vector<double, 2>{{own[k][0], own[k][1]}};
        });
    }
    template <class From>
    static bool acts_in(From const& from) {
        return from.dragged;
    }
    template <class Bodies, class Place, class Vector3>
    CATENA_HD static void add_on_body(Bodies const& bodies, Place k, Vector3& moment,
                                      Vector3& push) {
        if (!bodies.given.dragged) return;
        auto const drag = bodies.load(bodies.given.drag, k);
        Vector3 const omega = bodies.omega(k);
        push = plus_scaled(push, -drag[0], bodies.velocity(k) - cross(omega, bodies.r1(k)));
        moment = plus_scaled(moment, -drag[1], omega);
    }
};

}  // namespace catena::terms
