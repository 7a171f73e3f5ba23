// Point beads in branched chains, at the places of their paths (tree/branches.hpp), for the sweeps
// of matrices and biases and for the fused sweep. To its path, a bead with side paths is a bead
// with another inverse mass, a matrix E, and another force (src/dca/README.md, "Branched chains").
#pragma once

#include "dca/body_leaf.hpp"
#include "tree/branches.hpp"

namespace catena::dca {

/// Beads with side paths as their own paths see them, in the memory of a Space.
struct ForkBeads {
    /// Inverse of the bead's mass and of what its side links hold, E; W.
    Sym3* inverse_mass = nullptr;
    /// Force of the side paths on the bead at rest, and all other forces on the bead; W.
    Vec3 *push = nullptr, *force = nullptr;
};

/// Leaf of beads on projected handles. Places are the indices that sweeps pass; the views that they
/// pass count beads as the group does.
class BranchedLeaf {
  public:
    // As in BeadLeaf.
    static constexpr int K = 1;
    static constexpr bool beads = true, in_joints = false, projected = true,
                          reads_neighbours = true, by_inertia = false;
    /// All arrays must outlive the leaf. `fork` is the fork of each place, -1 for none; `ends`
    /// is 1 for the last place of each path.
    BranchedLeaf(GroupView const& group, std::int64_t const* body, std::int32_t const* fork,
                 std::uint8_t const* ends, ForkBeads const& forks)
        : group_(group), body_(body), fork_(fork), ends_(ends), forks_(forks) {}
    void set(ConfigurationView const& c) { direction_ = c.direction; }
    /// Sets where accelerate() writes joint forces, by bead; it may be absent.
    void set(DirectionsView const& joint_force) { joint_force_ = joint_force; }
    CATENA_HD GroupView const& group() const { return group_; }
    /// Returns the unit direction of the inboard link of the bead at a place; 0 without a link.
    CATENA_HD Vec3 inboard(std::int64_t place) const { return direction_.load(body_[place]); }

    CATENA_HD SegmentMatrix<double, 1> matrix(std::int64_t place) const {
        Vec3 const u1 = inboard(place), u2 = outboard(place);
        if (fork_[place] < 0) return bead_matrix(inverse_mass(place), u1, u2, Vector<double, 1>{});
        Sym3 const& e = forks_.inverse_mass[fork_[place]];
        Vec3 const by_inboard = e * u1;
        SegmentMatrix<double, 1> s;
        s.z11(0, 0) = dot(u1, by_inboard);
        s.z22(0, 0) = dot(u2, e * u2);
        s.z12(0, 0) = dot(u2, by_inboard);
        return s;
    }
    CATENA_HD SegmentBias<double, 1> bias(LoadsView const& loads, std::int64_t place) const {
        auto b = SegmentBias<double, 1>::zero();
        if (loads.force.origin || fork_[place] >= 0) {
            Vec3 const a = accelerated(place, force(loads, place));
            b = {{{dot(inboard(place), a)}}, {{dot(outboard(place), a)}}};
        }
        if (loads.bias) b.b1[0] = b.b1[0] + loads.bias.at(body_[place], 0);
        return b;
    }
    /// Writes the acceleration and the joint force of the bead at a place from the forces at the
    /// two links of its path. Of a fork, keeps the force of both links and of the loads instead of
    /// the acceleration.
    CATENA_HD void accelerate(LoadsView const& loads, std::int64_t place,
                              Vector<double, 1> const& inboard_force,
                              Vector<double, 1> const& outboard_force,
                              AccelerationsView const& out) const {
        if (joint_force_) joint_force_.store<1>(body_[place], inboard_force);
        if (!out.acceleration.origin && fork_[place] < 0) return;
        Vec3 const pushed =
            plus_scaled(plus_scaled(force(loads, place), inboard_force[0], inboard(place)),
                        -outboard_force[0], outboard(place));
        if (fork_[place] >= 0)
            forks_.force[fork_[place]] = pushed;
        else
            out.acceleration.store(body_[place], inverse_mass(place) * pushed);
    }

  private:
    CATENA_HD double inverse_mass(std::int64_t place) const {
        return group_.inverse_mass.load(body_[place])[0];
    }
    CATENA_HD Vec3 outboard(std::int64_t place) const {
        return ends_[place] != 0 ? Vec3::zero() : direction_.load(body_[place + 1]);
    }
    CATENA_HD Vec3 force(LoadsView const& loads, std::int64_t place) const {
        return loads.force.origin ? loads.force.load(body_[place]) : Vec3::zero();
    }
    /// Returns the acceleration of the bead at a place under a force in addition to that of its
    /// side paths.
    CATENA_HD Vec3 accelerated(std::int64_t place, Vec3 const& force) const {
        if (fork_[place] < 0) return inverse_mass(place) * force;
        return forks_.inverse_mass[fork_[place]] * (force + forks_.push[fork_[place]]);
    }

    GroupView group_;
    std::int64_t const* body_;
    std::int32_t const* fork_;
    std::uint8_t const* ends_;
    ForkBeads forks_;
    ConstView<3> direction_;
    DirectionsView joint_force_;
};

}  // namespace catena::dca
