// Inboard joints of a group's bodies in any Space.
#pragma once

#include <vector>

#include "dca/host_space.hpp"
#include "kinematics/joint_motion.hpp"
#include "tree/levels.hpp"

namespace catena {

/// First body (local) of each of the group's pieces.
std::vector<std::int64_t> first_bodies(ChainGroup const&);

/// Storage behind JointsView, and the constant properties of the bodies.
template <class Space>
class JointsIn {
    template <class T>
    using List = typename Space::template List<T>;
    template <int D>
    using Fixed = typename Space::template Fixed<D>;

  public:
    /// The group must outlive this object.
    JointsIn(ChainGroup const& group, Space const& space)
        : group_(group),
          first_body_(first_bodies(group)),
          model_(space.model(group)),
          bodies_(model_.view()),
          joint_(group.joints.type),
          piece_(first_body_),
          drive_(group.joints.drives),
          rotation_(group.joints.rotation),
          translation_(group.joints.translation),
          first_axis_(group.joints.first_axis),
          levels_(group.beads || group.linked ? std::span<std::int64_t const>{}
                                              : std::span(group.branching.inboard)),
          inboard_(group.branching.inboard),
          first_child_(levels_.first_child),
          child_(levels_.child),
          body_of_level_(levels_.body) {}

    JointsView view() const {
        bool const by_levels = levels_.levels() > 0;
        return {group_.size,
                joint_.data(),
                bodies_.is_first,
                bodies_.is_last,
                group_.planar,
                group_.joints.has_screws,
                bodies_.r1,
                bodies_.axes1,
                rotation_.view(),
                translation_.view(),
                first_axis_.view(),
                bodies_.screw,
                piece_.data(),
                std::ssize(first_body_),
                drive_.data(),
                std::ssize(group_.joints.drives),
                by_levels ? inboard_.data() : nullptr,
                by_levels ? first_child_.data() : nullptr,
                by_levels ? child_.data() : nullptr};
    }
    /// Levels of branched chains, on the host and as a list of their bodies in the Space. There are
    /// none of other chains.
    dca::Levels const& levels() const { return levels_; }
    List<std::int64_t> const& body_of_level() const { return body_of_level_; }
    /// Constant properties of the bodies, shared with the solver of the same Space.
    typename Space::Model const& model() const { return model_; }
    GroupView const& bodies() const { return bodies_; }

  private:
    ChainGroup const& group_;
    std::vector<std::int64_t> first_body_;  // On the host a List is a view.
    typename Space::Model model_;
    GroupView bodies_;
    List<JointType> joint_;
    List<std::int64_t> piece_;
    List<LocalDrive> drive_;
    Fixed<4> rotation_;
    Fixed<3> translation_, first_axis_;
    dca::Levels levels_;
    List<std::int64_t> inboard_, first_child_, child_, body_of_level_;
};

}  // namespace catena
