// Arrays and trees of the scan along chains, in any Space.
#pragma once

#include <vector>

#include "dca/host_space.hpp"
#include "kinematics/joint_scan.hpp"

namespace catena {

/// Storage slot of each body's run.
std::vector<std::int32_t> run_slots(ChainGroup const&);

/// Storage behind the arrays of JointScan, which documents them.
template <class Space>
class ScanArrays {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;
    using Records = typename Space::template Records<Motion, dca::Order::plain>;

  public:
    explicit ScanArrays(ChainGroup const& group)
        : slot_of_body_(run_slots(group)),
          slot_(slot_of_body_),
          rotation_(group.size),
          omega_(group.size),
          translation_(group.size),
          velocity_(group.size),
          next_meeting_(group.joints.moving_meeting() ? 1 : 0),
          whole_(group.schedule.slots),
          before_(group.schedule.slots) {}

    /// The scan over these arrays.
    JointScan scan(JointsView const& joints, StateView const& state, MotionView const& motion) {
        return {joints,
                state,
                motion,
                rotation_.view(),
                omega_.view(),
                translation_.view(),
                velocity_.view(),
                slot_.data(),
                whole_.view(),
                before_.view(),
                next_meeting_.view()};
    }
    ConstView<4> rotation() { return rotation_.view(); }
    MotionRecords before() { return before_.view(); }
    /// Entry 0 is sent to the inboard neighbour, entry 1 is received from the outboard one.
    View<9> next_meeting() { return next_meeting_.view(); }

  private:
    std::vector<std::int32_t> slot_of_body_;  // On the host a List is a view.
    typename Space::template List<std::int32_t> slot_;
    FieldOf<4> rotation_;
    FieldOf<3> omega_, translation_, velocity_;
    FieldOf<9> next_meeting_;
    Records whole_, before_;
};

/// Trees that the passes of a scan climb and descend.
template <class Space>
class ScanTrees {
    template <class T>
    using List = typename Space::template List<T>;
    using Tree = typename Space::ScanTree;

  public:
    explicit ScanTrees(dca::Schedule const& schedule)
        : own_(schedule.runs, schedule.levels, schedule.roots, schedule.slots),
          top_(no_runs_, schedule.top_levels, schedule.top_roots, schedule.slots),
          runs_(schedule.runs),
          roots_(schedule.roots),
          top_roots_(schedule.top_roots) {}

    /// Tree over this rank's units.
    Tree const& own() const { return own_; }
    /// Tree above the units of chains that ranks share.
    Tree const& top() const { return top_; }
    /// All runs of this rank.
    List<dca::Run> const& runs() const { return runs_; }
    /// Roots of own() and of top().
    List<dca::Root> const& roots() const { return roots_; }
    List<dca::Root> const& top_roots() const { return top_roots_; }

  private:
    std::vector<dca::Run> no_runs_;
    Tree own_, top_;
    List<dca::Run> runs_;
    List<dca::Root> roots_, top_roots_;
};

}  // namespace catena
