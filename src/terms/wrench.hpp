// Constant wrenches on rigid bodies.
#pragma once

#include "keys/maps.hpp"
#include "terms/force_term.hpp"

namespace catena::terms {

/// The arrays hold the constant wrenches of all terms (constant_wrench() in force_terms.hpp).
struct Wrench : ForceTerm {
    static constexpr char const* name = "wrenches";
    static constexpr bool known_to_peers = true;
    static constexpr bool does_work = true;
    static constexpr bool pushes = true;
    static constexpr bool uses_orientations = true;
    static constexpr bool exerts_forces = true;
    static constexpr bool on_links = false;
    static constexpr bool has_constant_wrench = true;
    static constexpr char const* in_check = "wrenches";
    static constexpr char const* body_key = "wrench";
    static constexpr char const* saving = "external wrenches";

    static std::int64_t count(Scene const&, ChainSpec const& chain) {
        std::int64_t count = 0;
        for (auto const& [torque, force] : chain.bodies.wrench)
            count += acts(torque) || acts(force) ? 1 : 0;
        return count;
    }
    static void read_body(scene::Node const& body, std::size_t k, ForceSpec const&,
                          ChainSpec& chain) {
        scene::Node const* const given = body.find(body_key);
        if (!given) return;
        scene::Fields const parts(*given, scene::keys::wrench);
        ConstantWrench wrench{Vec3::zero(), Vec3::zero()};
        if (auto const* const torque = parts.find("torque")) wrench.first = scene::vector3(*torque);
        if (auto const* const force = parts.find("force")) wrench.second = scene::vector3(*force);
        set_entry(chain.bodies.wrench, k, chain.size(), wrench, {Vec3::zero(), Vec3::zero()});
    }
    template <class Use>
    static void columns(Use const& use) {
        use(Column<ConstantWrench>{&BodyArrays::wrench, 4});
    }
    template <class Table>
    static void read_table(Table& table, ChainSpec& chain) {
        table.rows("wrench", 6, chain.bodies.wrench, [](std::size_t, double const* v) {
            return ConstantWrench{Vec3{{v[0], v[1], v[2]}}, Vec3{{v[3], v[4], v[5]}}};
        });
    }
    static bool constant_wrench(ChainSpec const& chain, std::size_t k, ConstantWrench& sum) {
        if (chain.bodies.wrench.empty()) return false;
        sum = chain.bodies.wrench[k];
        return true;
    }
    static void put(Scene& scene, std::size_t bodies) {
        scene.chains[0].bodies.wrench.assign(bodies, {Vec3{{1, 1, 1}}, Vec3{{1, 1, 1}}});
    }

    template <template <int> class F>
    struct Arrays {
        F<3> wrench_torque, wrench_force;  // About and at the centre of mass, W.
        bool wrenches = false;
    };
    template <class To, class From, class Convert>
    static To converted(From const& from, Convert const& convert) {
        return {convert(from.wrench_torque), convert(from.wrench_force), from.wrenches};
    }
    template <class Maker, class To>
    static void collect(Maker const& maker, To& to) {
        to.wrenches = maker.has_constant_wrenches();
        if (!to.wrenches) return;
        to.wrench_torque = maker.template field<3>(
            [&](ChainSpec const& c, std::size_t k) { return maker.constant_wrench(c, k).first; });
        to.wrench_force = maker.template field<3>(
            [&](ChainSpec const& c, std::size_t k) { return maker.constant_wrench(c, k).second; });
    }
    template <class From>
    static bool acts_in(From const& from) {
        return from.wrenches;
    }
};

}  // namespace catena::terms
