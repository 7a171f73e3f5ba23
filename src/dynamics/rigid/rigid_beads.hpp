// Carried beads of rigid bodies, for OpenMM on the same GPU.
#pragma once

#include "dynamics/rigid/rigid_bodies.hpp"

namespace catena {

/// Exchanges positions and forces of carried beads with OpenMM.
template <class Space>
class RigidBeads final : public DeviceBeads {
  public:
    /// The bodies must outlive this object.
    explicit RigidBeads(RigidBodies<Space>& bodies) : bodies_(bodies) {}

    std::int64_t count() const override { return bodies_.group.carried.count(); }
    void* stream() const override {
        if constexpr (requires { bodies_.space.stream(); }) return bodies_.space.stream();
        return nullptr;
    }
    void put_positions(DeviceParticles const& particles) override {
        bodies_.space.for_each(count(), [f = bodies_.forces(), particles] CATENA_LAMBDA(
                                            std::int64_t i) { particles.put(i, f.put_bead(i)); });
    }
    void show(ShownBeads const& shown) override {
        bodies_.space.for_each(count(), [f = bodies_.forces(), shown] CATENA_LAMBDA(
                                            std::int64_t i) { shown.show(i, f.put_bead(i)); });
    }
    void add_forces(DeviceParticles const& particles) override {
        bodies_.space.for_each(count(), [f = bodies_.forces(), particles] CATENA_LAMBDA(
                                            std::int64_t i) { f.add_bead_force(i, particles); });
    }
    ConstView<3> host_positions() override {
        bodies_.put_beads();
        return bodies_.loads.beads.bead_positions();
    }

  private:
    RigidBodies<Space>& bodies_;
};

}  // namespace catena
