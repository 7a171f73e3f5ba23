// Parts of the level solver on the host, one per kind of leaf, compiled in several sources.
#pragma once

#include "dca/leaf_choice.hpp"
#include "dca/space_levels.hpp"

namespace catena::dca {

/// Makes the part of the chosen leaf. Action of the functions in leaf_choice.hpp. All referenced
/// objects must outlive the part.
struct MakeHostPart {
    ChainGroup const& group;
    LevelWork const& work;
    Executor const& executor;

    template <class Leaf>
    std::unique_ptr<LevelPart> operator()(Of<Leaf>) const {
        return std::make_unique<SpaceLevels<Leaf, HostSpace, HostCrossing>>(group, work,
                                                                            HostSpace(executor));
    }
};

/// Makes the part of a group in joint coordinates with floating handles.
std::unique_ptr<LevelPart> make_joint_part(MakeHostPart const&);

}  // namespace catena::dca
