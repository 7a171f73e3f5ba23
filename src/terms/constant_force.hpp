// Constant forces on single bodies and beads, such as those that pull a chain.
#pragma once

#include "terms/force_term.hpp"

namespace catena::terms {

/// The force acts at the centre of mass, W. Its energy is -force . position.
struct ConstantForce : ForceTerm {
    static constexpr char const* name = "constant_forces";
    static constexpr char const* energy = "constant_force";
    static constexpr bool pushes = true;
    static constexpr bool uses_orientations = true;
    static constexpr bool exerts_forces = true;
    static constexpr bool has_constant_wrench = true;
    static constexpr char const* on_one = "body or bead";
    static constexpr char const* on_many = "bodies or beads";
    static constexpr char const* in_check = "constant forces";
    static constexpr char const* body_key = "force";

    static std::int64_t count(Scene const&, ChainSpec const& chain) {
        std::int64_t count = 0;
        if (numbers_of(chain, name, 0) == nullptr) return count;
        for (std::size_t k = 0; k < chain.size(); ++k) count += acts(force_on(chain, k)) ? 1 : 0;
        return count;
    }
    static void read_body(scene::Node const& body, std::size_t k, ForceSpec const&,
                          ChainSpec& chain) {
        if (scene::Node const* const given = body.find(body_key))
            set(chain, k, scene::vector3(*given));
    }
    template <class Table>
    static void read_table(Table& table, ChainSpec& chain) {
        if (!table.has(body_key)) return;
        std::vector<Vec3> forces;
        table.vectors(body_key, forces, [&](std::size_t k, Vec3 const& v) { set(chain, k, v); });
    }
    static bool constant_wrench(ChainSpec const& chain, std::size_t k, ConstantWrench& sum) {
        if (numbers_of(chain, name, k) == nullptr) return false;
        sum = {Vec3::zero(), force_on(chain, k)};
        return true;
    }

    template <template <int> class F>
    struct Arrays {
        F<3> constant_force;  // W.
        bool forced = false;
    };
    template <class To, class From, class Convert>
    static To converted(From const& from, Convert const& convert) {
        return {convert(from.constant_force), from.forced};
    }
    template <class Maker, class To>
    static void collect(Maker const& maker, To& to) {
        to.forced = maker.template any<ConstantForce>();
        if (to.forced) to.constant_force = maker.template field<3>(force_on);
    }
    template <class From>
    static bool acts_in(From const& from) {
        return from.forced;
    }
    template <class From>
    static double energy_of(From const& from, PlacedBody const& body) {
        return from.forced ? -dot(from.constant_force[body.k], body.centre) : 0;
    }

  private:
    static Vec3 force_on(ChainSpec const& chain, std::size_t k) {
        double const* const v = numbers_of(chain, name, k);
        return v ? Vec3{{v[0], v[1], v[2]}} : Vec3::zero();
    }
    /// A force of 0 leaves the chain as it is without the key.
    static void set(ChainSpec& chain, std::size_t k, Vec3 const& force) {
        if (!acts(force) && numbers_of(chain, name, k) == nullptr) return;
        std::copy(force.data, force.data + 3, numbers_for(chain, name, 3, k));
    }
};

}  // namespace catena::terms
