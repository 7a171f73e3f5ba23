// What the sweeps read of a group's model, as plain pointers: of arrays on the host or on a device.
#pragma once

#include <cstdint>

#include "math/field.hpp"

namespace catena {

struct GroupView {
    std::int64_t size = 0;
    std::uint8_t const *is_first = nullptr, *is_last = nullptr;  // of its chain
    std::int32_t const* jointed_tip =
        nullptr;                      // as ChainGroup::jointed_tip; null where no chain has one
    Vec3 const* tip_screw = nullptr;  // of each jointed tip, as ChainGroup::screw
    ConstView<1> inverse_mass;
    ConstView<6> inverse_inertia;
    ConstView<3> r1, r2;
    ConstView<6> axes1, axes2;
    ConstView<3> screw;
    ConstView<1> mass;  // where sweeps read them (ChainGroup::mass_of_sweeps)
    ConstView<6> inertia;

    CATENA_HD bool has_jointed_tip(std::int64_t k) const {
        return jointed_tip && jointed_tip[k] >= 0;
    }
    /// Of the joint on the outboard side of body k, where there is one.
    CATENA_HD Vec3 outboard_screw(std::int64_t k) const {
        return has_jointed_tip(k) ? tip_screw[jointed_tip[k]] : screw.load(k + 1);
    }
};

}  // namespace catena
