#include "integrate/joint_lanes.hpp"

namespace catena {
namespace {

/// Whether bodies k to k + lanes - 1 go side by side: what they are asked for is the same of each, and found without a decision that
/// depends on numbers. Their neighbours are of the same chain on this rank: none is the chain's first or last body, so none makes a run
/// by itself.
bool go_side_by_side(ChainGroup const& group, bool springs, std::int64_t k, int lanes) {
    if (k == 0 || k + lanes >= group.size) return false;
    JointType const type = group.joint[static_cast<std::size_t>(k)];
    switch (type) {
        case JointType::spherical:
            if (springs) return false;
            break;
        case JointType::revolute:
        case JointType::universal:
        case JointType::prismatic:
        case JointType::helical:
            break;
        default:
            return false;
    }
    for (std::int64_t i = k; i <= k + lanes; ++i) {  // the joint after them too, which moves where they meet it
        auto const at = static_cast<std::size_t>(i);
        if (group.joint[at] != type || group.is_first[at]) return false;
    }
    return true;
}

}  // namespace

JointLanes::JointLanes(ChainGroup const& group, bool springs, SimdLevel level) {
    if (level == SimdLevel::off || !rounds_as_vectors() || !group.drives.empty() || group.carried_in_scene || !group.implicit_joint.empty())
        return;
    for (bool const positions : {false, true})
        loops_[positions ? 1 : 0] = level == SimdLevel::avx512 ? avx512_joint_loops(positions) : avx2_joint_loops(positions);
    int const lanes = lanes_of(level);
    for (std::int64_t k = 0; k < group.size;) {
        if (go_side_by_side(group, springs, k, lanes)) {
            first_.push_back(k);
            k += lanes;
        } else {
            others_.push_back(k);
            ++k;
        }
    }
    if (first_.empty()) {
        others_ = {};
        return;
    }
    runs_ = dca::deal_out_runs(group, lanes, false);
    tree_.emplace(runs_.others, group.schedule.levels, group.schedule.roots, group.schedule.slots);
}

}  // namespace catena
