// Sums of wrenches from the tip inward, in the order of the canonical tree, so that results do not
// depend on the number of ranks.
#include "dynamics/joint/out_of_plane.hpp"

namespace catena {
namespace {

/// Sum over two consecutive stretches of bodies, about the inboard joint of the first.
NeededWrench join(NeededWrench const& inboard, NeededWrench const& outboard) {
    return {inboard.force + outboard.force,
            inboard.torque + outboard.torque + cross(inboard.to_next, outboard.force),
            inboard.to_next + outboard.to_next};
}

NeededWrench const nothing{Vec3::zero(), Vec3::zero(), Vec3::zero()};

/// Sum over all bodies outboard of each local unit, up to the tip.
std::vector<NeededWrench> beyond(ChainGroup const& group, Communicator const& communicator,
                                 std::vector<LocalUnit> const& units,
                                 std::vector<NeededWrench> const& own) {
    std::vector<NeededWrench> after(units.size(), nothing);
    for (std::size_t i = units.size(); i-- > 1;)
        if (units[i].piece == units[i - 1].piece) after[i - 1] = join(own[i], after[i]);
    std::vector<NeededWrench> const shared = gather_shared_units(communicator, group, units, own);
    std::size_t first_of_chain = 0;
    for (int chain = 0; chain < group.partition.chains() && !shared.empty(); ++chain) {
        if (!group.partition.is_split(chain)) continue;
        auto const count = static_cast<std::size_t>(group.partition.trees[chain].units);
        NeededWrench sum = nothing;
        for (std::size_t unit = count; unit-- > 0;) {
            for (std::size_t i = 0; i < units.size(); ++i)
                if (group.pieces[units[i].piece].chain == chain &&
                    units[i].index == static_cast<std::int64_t>(unit))
                    after[i] = sum;
            sum = join(shared[first_of_chain + unit], sum);
        }
        first_of_chain += count;
    }
    return after;
}

}  // namespace

std::vector<std::pair<Vec3, Vec3>> sums_from_tip(ChainGroup const& group,
                                                 Communicator const& communicator,
                                                 std::vector<NeededWrench> const& needed) {
    std::vector<LocalUnit> const units = local_units(group);
    std::vector<NeededWrench> own;
    for (LocalUnit const& unit : units) {
        NeededWrench sum = nothing;
        for (std::int64_t k = unit.begin + unit.count; k-- > unit.begin;)
            sum = join(needed[k], sum);
        own.push_back(sum);
    }
    std::vector<NeededWrench> const after = beyond(group, communicator, units, own);
    std::vector<std::pair<Vec3, Vec3>> wrench(needed.size());
    for (std::size_t i = 0; i < units.size(); ++i) {
        NeededWrench sum = after[i];
        for (std::int64_t k = units[i].begin + units[i].count; k-- > units[i].begin;) {
            sum = join(needed[k], sum);
            wrench[k] = {sum.force, sum.torque};
        }
    }
    return wrench;
}

}  // namespace catena
