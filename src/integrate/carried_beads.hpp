// Beads that rigid bodies carry: where they are, and what forces on them do to the bodies.
#pragma once

#include "chain/chain_group.hpp"
#include "dca/executor.hpp"
#include "force/device_beads.hpp"

namespace catena {

struct Wrench {
    Vec3 torque, force;  // about the centre of mass; W
};

class CarriedBeadForces {
  public:
    explicit CarriedBeadForces(ChainGroup const& group) : group_(group), position_(group.carried_beads()), force_(group.carried_beads()) {}

    bool any() const { return position_.size() > 0; }
    /// `centre(k)`: the centre of mass of body k, W; `turn(k)`: its axes in W.
    template <class Centre, class Turn>
    ConstView<3> positions(Executor const& executor, Centre const& centre, Turn const& turn) {
        if (!any()) return {};
        executor.for_each(group_.size, [&](std::int64_t k) {
            Vec3 const x = centre(k);
            Mat3 const r = turn(k);
            for (std::int64_t i = group_.bead_offset[k]; i < group_.bead_offset[k + 1]; ++i)
                position_.set(i, x + r * group_.bead_place[static_cast<std::size_t>(i)]);
        });
        return std::as_const(position_).view();
    }
    /// For others to add to, W.
    View<3> forces() { return any() ? force_.view() : View<3>{}; }
    void clear() {
        for (std::int64_t i = 0; i < force_.size(); ++i) force_.set(i, Vec3::zero());
    }
    /// On body k, whose axes are `turn` in W. Precondition: any().
    Wrench on_body(std::int64_t k, Mat3 const& turn) const {
        Wrench w{Vec3::zero(), Vec3::zero()};
        for (std::int64_t i = group_.bead_offset[k]; i < group_.bead_offset[k + 1]; ++i) {
            Vec3 const f = force_[i];
            w.force = w.force + f;
            w.torque = w.torque + cross(turn * group_.bead_place[static_cast<std::size_t>(i)], f);
        }
        return w;
    }

  private:
    ChainGroup const& group_;
    Field<3> position_, force_;
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
