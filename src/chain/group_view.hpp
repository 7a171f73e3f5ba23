// View of a group's model for sweeps: plain pointers to arrays on the host or on a device.
#pragma once

#include <cstdint>

#include "math/field.hpp"

namespace catena {

/// Non-owning view of the arrays of a ChainGroup that sweeps read, with the same names and units.
struct GroupView {
    std::int64_t size = 0;
    std::uint8_t const *is_first = nullptr, *is_last = nullptr;  // first and last bodies of chains
    /// LocalEnds::jointed_tip; null if no chain of the group has a jointed tip.
    std::int32_t const* jointed_tip = nullptr;
    Vector<double, 4> const* tip_screw = nullptr;  // screw of each jointed tip
    ConstView<1> inverse_mass;
    ConstView<6> inverse_inertia;
    ConstView<3> r1, r2;
    ConstView<6> axes1, axes2;
    ConstView<4> screw;
    ConstView<1> mass;  // empty unless sweeps read them (ChainGroup::mass_of_sweeps())
    ConstView<6> inertia;

    CATENA_HD bool has_jointed_tip(std::int64_t k) const {
        return jointed_tip && jointed_tip[k] >= 0;
    }
    /// Screw of the joint on the outboard side of body k. Precondition: there is one.
    CATENA_HD Vector<double, 4> outboard_screw(std::int64_t k) const {
        return has_jointed_tip(k) ? tip_screw[jointed_tip[k]] : screw.load(k + 1);
    }
};

}  // namespace catena
