// Dampers of joints.
#pragma once

#include "terms/force_term.hpp"

namespace catena::terms {

struct JointDamper : ForceTerm {
    static constexpr char const* name = "dampers";
    static constexpr bool known_to_peers = true;
    static constexpr bool does_work = true;
    static constexpr bool depends_on_velocities = true;
    static constexpr bool acts_along_joints = true;
    static constexpr char const* on_one = "joint";
    static constexpr char const* on_many = "joints";
    static constexpr char const* in_messages = "joint damping";
    static constexpr char const* remedy = "set `damping: 0`";
    static constexpr char const* in_check = "dampers";
    static constexpr char const* saving = "joint dampers";

    static std::int64_t count(Scene const&, ChainSpec const& chain) {
        return count_of(chain.bodies.damping);
    }
    /// True if the term acts on body k, whose joint it is.
    static bool acts_on(ChainSpec const& chain, std::size_t k) {
        return acts(entry(chain.bodies.damping, k));
    }
    template <class Use>
    static void columns(Use const& use) {
        use(Column<Vec3>{&BodyArrays::damping, 2});
    }
    template <class Table>
    static void read_table(Table& table, ChainSpec& chain) {
        if (table.has("damping")) table.resistances("damping", chain.bodies.damping);
    }
    static void put(Scene& scene, std::size_t bodies) {
        scene.chains[0].bodies.damping.assign(bodies, Vec3{{1, 1, 1}});
    }

    template <template <int> class F>
    struct Arrays {
        F<3> damping;  // One number per joint coordinate.
        bool dampers = false;
    };
    template <class To, class From, class Convert>
    static To converted(From const& from, Convert const& convert) {
        return {convert(from.damping), from.dampers};
    }
    template <class Maker, class To>
    static void collect(Maker const& maker, To& to) {
        to.dampers = maker.template any<JointDamper>();
        if (to.dampers)
            to.damping = maker.template field<3>(
                [](ChainSpec const& c, std::size_t k) { return entry(c.bodies.damping, k); });
    }
    /// Adds the damper's load along one coordinate of rate `qd`.
    template <class Real>
    CATENA_HD static Real plus(Real const& along, Real const& damping, Real const& qd) {
        return along - damping * qd;
    }
    /// Adds the loads along the coordinates of a joint.
    template <class Joint, class Vector3>
    CATENA_HD static void add_along(Joint const& joint, Vector3& along) {
        if (!joint.given.dampers) return;
        auto const damping = joint.load(joint.given.damping);
        for (int i = 0; i < 3; ++i) along[i] = plus(along[i], damping[i], joint.qd[i]);
    }
    template <class Axis>
    CATENA_HD static void add_about_axis(Axis const& axis, double& along) {
        if (axis.given.dampers) along = plus(along, axis.at(axis.given.damping), axis.qd());
    }
};

}  // namespace catena::terms
