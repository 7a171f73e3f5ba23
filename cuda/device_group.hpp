// A group's model on a device.
#pragma once

#include "chain/chain_group.hpp"
#include "cuda/owners.hpp"

namespace catena::cuda {

class DeviceGroup {
  public:
    explicit DeviceGroup(ChainGroup const& group)
        : size_(group.size),
          is_last_(group.is_last),
          restricted_(group.restricted_of_joint),
          jointed_tip_(group.jointed_tip),
          tip_screw_(group.tip_screw),
          inverse_mass_(copy_of(group.inverse_mass)),
          inverse_inertia_(copy_of(group.inverse_inertia)),
          r1_(copy_of(group.r1)),
          r2_(copy_of(group.r2)),
          axes1_(copy_of(group.axes1)),
          axes2_(copy_of(group.axes2)),
          screw_(copy_of(group.screw)) {}

    GroupView view() const {
        return {size_,      is_last_.data(), jointed_tip_.data(), tip_screw_.data(), inverse_mass_.view(), inverse_inertia_.view(),
                r1_.view(), r2_.view(),      axes1_.view(),       axes2_.view(),     screw_.view()};
    }
    std::uint8_t const* restricted() const { return restricted_.data(); }

  private:
    template <int D>
    static DeviceField<D> copy_of(Field<D> const& host) {
        if (!host.view().origin || host.size() == 0) return {};
        DeviceField<D> field(host.size());
        field.upload(host.view(), nullptr);
        return field;
    }
    std::int64_t size_;
    Buffer<std::uint8_t> is_last_, restricted_;
    Buffer<std::int32_t> jointed_tip_;
    Buffer<Vec3> tip_screw_;
    DeviceField<1> inverse_mass_;
    DeviceField<6> inverse_inertia_;
    DeviceField<3> r1_, r2_;
    DeviceField<9> axes1_, axes2_;
    DeviceField<3> screw_;
};

}  // namespace catena::cuda
