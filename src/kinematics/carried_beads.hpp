// Beads that rigid bodies carry: where they are, and what forces on them do to the bodies, for
// every Space.
#pragma once

#include <utility>

#include "chain/chain_group.hpp"
#include "neighbours/device_beads.hpp"

namespace catena {

template <class Real>
struct WrenchOf {
    Vector<Real, 3> torque, force;  // about the centre of mass; W
};
using Wrench = WrenchOf<double>;

/// `centre`: the centre of mass of body k, W; `axes`: its axes in W.
struct CarriedBeadsView {
    std::int64_t const* offset = nullptr;  // absent where no body of the group carries any
    Vec3 const* place = nullptr;           // from the centre of mass, B
    View<3> position, force;               // W

    CATENA_HD explicit operator bool() const { return offset != nullptr; }
    CATENA_HD void put(std::int64_t k, Vec3 const& centre, Mat3 const& axes) const {
        for (std::int64_t i = offset[k]; i < offset[k + 1]; ++i)
            position.store(i, centre + axes * place[i]);
    }
    CATENA_HD void clear_forces(std::int64_t k) const {
        for (std::int64_t i = offset[k]; i < offset[k + 1]; ++i) force.store(i, Vec3::zero());
    }
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

template <class Space>
class CarriedBeadsIn {
  public:
    /// The group must outlive it.
    CarriedBeadsIn(ChainGroup const& group, Space const& space)
        : any_(group.carried_beads() > 0),
          in_scene_(group.carried_in_scene),
          space_(space),
          offset_(group.bead_offset),
          place_(group.bead_place),
          position_(group.carried_beads()),
          force_(group.carried_beads()) {}

    /// On this rank; in the group.
    bool any() const { return any_; }
    bool in_scene() const { return in_scene_; }
    CarriedBeadsView view() {
        return {in_scene_ ? offset_.data() : nullptr, place_.data(), position_.view(),
                force_.view()};
    }
    typename Space::template FieldOf<3> const& force() const { return force_; }
    // What BeadHost's members of these names promise.
    ConstView<3> bead_positions() {
        return any_ ? space_.pull(position_, position_mirror_) : View<3>{};
    }
    View<3> bead_forces() {
        forces_are_out_ = any_;
        return any_ ? space_.pull(force_, force_mirror_) : View<3>{};
    }
    void take_bead_forces() {
        if (std::exchange(forces_are_out_, false)) space_.push(force_, force_mirror_);
    }

  private:
    bool any_, in_scene_, forces_are_out_ = false;
    Space space_;
    typename Space::template List<std::int64_t> offset_;
    typename Space::template List<Vec3> place_;
    typename Space::template FieldOf<3> position_, force_;
    typename Space::template Mirror<3> position_mirror_, force_mirror_;
};

/// Chains whose beads, or beads on whose bodies, feel forces from outside.
class BeadHost {
  public:
    virtual ~BeadHost() = default;
    virtual ChainGroup const& group() const = 0;
    /// At the configuration of now, W; absent where there are none.
    virtual ConstView<3> bead_positions() = 0;
    /// For others to add to, W; absent where there are none.
    virtual View<3> bead_forces() = 0;
    /// What was added there since the forces were set counts from here on.
    virtual void take_bead_forces() = 0;
    /// The same where a GPU holds them; nullptr where it does not.
    virtual DeviceBeads* on_device() { return nullptr; }
};

}  // namespace catena
