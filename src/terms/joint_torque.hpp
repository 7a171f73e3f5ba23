// Given torques of joints along their coordinates.
#pragma once

#include "terms/force_term.hpp"

namespace catena::terms {

struct JointTorque : ForceTerm {
    static constexpr char const* name = "torques";
    static constexpr bool known_to_peers = true;
    static constexpr bool does_work = true;
    static constexpr bool pushes = true;
    static constexpr bool acts_along_joints = true;
    static constexpr char const* on_one = "joint";
    static constexpr char const* on_many = "joints";
    static constexpr char const* in_check = "torques";

    static std::int64_t count(Scene const&, ChainSpec const& chain) {
        return count_of(chain.bodies.torque);
    }
    template <class Use>
    static void columns(Use const& use) {
        use(Column<Vec3>{&BodyArrays::torque, 0});
    }
    template <class Table>
    static void read_table(Table& table, ChainSpec& chain) {
        if (table.has("torque")) table.coordinates("torque", chain.bodies.torque);
    }

    template <template <int> class F>
    struct Arrays {
        F<3> torque;  // One number per joint coordinate; zeros if other terms act on joints.
    };
    template <class To, class From, class Convert>
    static To converted(From const& from, Convert const& convert) {
        return {convert(from.torque)};
    }
    template <class Maker, class To>
    static void collect(Maker const& maker, To& to) {
        if (maker.has_joint_loads())
            to.torque = maker.template field<3>(
                [](ChainSpec const& c, std::size_t k) { return entry(c.bodies.torque, k); });
    }
    /// Sum of the joint's loads, which begins with the torque.
    template <class Joint>
    CATENA_HD static auto along(Joint const& joint) {
        return joint.load(joint.given.torque);
    }
};

}  // namespace catena::terms
