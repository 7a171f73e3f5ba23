// Parts of the level solver on the host for floating handles in joint coordinates.
#include "dca/solvers/host_levels.hpp"

namespace catena::dca {

std::unique_ptr<LevelPart> make_joint_part(MakeHostPart const& make) {
    return with_joint_leaf(make.group, make);
}

}  // namespace catena::dca
