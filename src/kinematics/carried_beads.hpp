// Beads carried by rigid bodies, in any Space: their positions follow from the body's pose, and the
// forces on them add up to a wrench on the body. Ground axes are W, body axes are B. Positions are
// in nm and forces in kJ/mol/nm, unless the scene has `units: si`.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "chain/chain_group.hpp"
#include "neighbours/device_beads.hpp"

namespace catena {

/// Wrench on one body or, with vector lanes as `Real`, on several bodies.
template <class Real>
struct WrenchOf {
    Vector<Real, 3> torque, force;  // About the centre of mass, W.
};
using Wrench = WrenchOf<double>;

/// View of a group's carried beads for loops over bodies. In its members, `centre` is the centre of
/// mass of body k (W) and `axes` is the rotation matrix of B in W.
struct CarriedBeadsView {
    /// Body k carries beads [offset[k], offset[k + 1]). Null if no body of the group carries any.
    std::int64_t const* offset = nullptr;
    std::int64_t const* body = nullptr;  // Body of each carried bead.
    Vec3 const* place = nullptr;         // Offset from the centre of mass, B.
    View<3> position, force;             // Indexed by carried bead, W.

    CATENA_HD explicit operator bool() const { return offset != nullptr; }
    /// Stores and returns the position of bead i of a body.
    CATENA_HD Vec3 put_bead(std::int64_t i, Vec3 const& centre, Mat3 const& axes) const {
        Vec3 const x = centre + axes * place[i];
        position.store(i, x);
        return x;
    }
    /// Stores the positions of the beads of body k.
    CATENA_HD void put(std::int64_t k, Vec3 const& centre, Mat3 const& axes) const {
        for (std::int64_t i = offset[k]; i < offset[k + 1]; ++i) put_bead(i, centre, axes);
    }
    /// Sets the forces on the beads of body k to zero.
    CATENA_HD void clear_forces(std::int64_t k) const {
        for (std::int64_t i = offset[k]; i < offset[k + 1]; ++i) force.store(i, Vec3::zero());
    }
    /// Sum of the forces on the beads of body k, and their torque about its centre of mass (W).
    CATENA_HD Wrench on_body(std::int64_t k, Mat3 const& axes) const {
        Wrench w{Vec3::zero(), Vec3::zero()};
        for (std::int64_t i = offset[k]; i < offset[k + 1]; ++i) {
            Vec3 const f = force.load(i);
            w.force = w.force + f;
            w.torque = w.torque + cross(axes * place[i], f);
        }
        return w;
    }
};

/// Body of each of the group's carried beads.
inline std::vector<std::int64_t> bodies_of_beads(ChainGroup const& group) {
    std::vector<std::int64_t> bodies;
    bodies.reserve(static_cast<std::size_t>(group.carried.count()));
    for (std::size_t k = 0; k + 1 < group.carried.offset.size(); ++k)
        bodies.insert(
            bodies.end(),
            static_cast<std::size_t>(group.carried.offset[k + 1] - group.carried.offset[k]),
            static_cast<std::int64_t>(k));
    return bodies;
}

/// Arrays of a group's carried beads in a Space, with host copies for force fields that run on the
/// host.
template <class Space>
class CarriedBeadsIn {
  public:
    /// The group must outlive this object.
    CarriedBeadsIn(ChainGroup const& group, Space const& space)
        : any_(group.carried.count() > 0),
          in_scene_(group.carried.in_scene),
          space_(space),
          bodies_(bodies_of_beads(group)),
          offset_(group.carried.offset),
          body_(bodies_),
          place_(group.carried.place),
          position_(group.carried.count()),
          force_(group.carried.count()) {}

    /// True if this rank has carried beads.
    bool any() const { return any_; }
    /// True if any rank's part of the group has carried beads.
    bool in_scene() const { return in_scene_; }
    CarriedBeadsView view() {
        return {in_scene_ ? offset_.data() : nullptr, body_.data(), place_.data(), position_.view(),
                force_.view()};
    }
    /// Forces by carried bead, W, in the Space.
    typename Space::template FieldOf<3> const& force() const { return force_; }
    // Implement BeadHost's members of the same names.
    ConstView<3> bead_positions() {
        return any_ ? space_.pull(position_, position_mirror_) : View<3>{};
    }
    View<3> bead_forces() {
        if (!any_) return {};
        shown_ = space_.pull(force_, force_mirror_);
        return *shown_;
    }
    void take_bead_forces() {
        if (std::exchange(shown_, std::nullopt)) space_.push(force_, force_mirror_);
    }

  private:
    bool any_, in_scene_;
    std::optional<View<3>> shown_;  // the host's copy of the forces, which it may have changed
    Space space_;
    std::vector<std::int64_t> bodies_;  // On the host a List is a view.
    typename Space::template List<std::int64_t> offset_, body_;
    typename Space::template List<Vec3> place_;
    typename Space::template FieldOf<3> position_, force_;
    typename Space::template Mirror<3> position_mirror_, force_mirror_;
};

/// Interface of chains that receive external forces on beads: the chain's own beads, or beads
/// carried by its rigid bodies.
class BeadHost {
  public:
    virtual ~BeadHost() = default;
    virtual ChainGroup const& group() const = 0;
    /// Positions at the current configuration, on the host, W. The view has no origin if the group
    /// has no beads.
    virtual ConstView<3> bead_positions() = 0;
    /// Force accumulator on the host, W; force fields add to it. The view has no origin if the
    /// group has no beads.
    virtual View<3> bead_forces() = 0;
    /// Applies the forces that were added to bead_forces() since the forces were last set.
    virtual void take_bead_forces() = 0;
    /// Interface for a force field on the same GPU; null if positions and forces are not on a GPU.
    virtual DeviceBeads* on_device() { return nullptr; }
};

}  // namespace catena
