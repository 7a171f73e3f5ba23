// Forward kinematics of chains in joint coordinates, in any Space. A scan along the canonical tree
// composes the joints' motions, in parallel over runs of bodies and across ranks.
#pragma once

#include <memory>
#include <vector>

#include "kinematics/joints_in.hpp"
#include "kinematics/scan_in.hpp"
#include "tree/frontier_exchange.hpp"

namespace catena {

/// Storage behind StateView: the state of body chains in joint coordinates.
template <class Space>
struct JointCoordinates {
    typename Space::template FieldOf<4> q;
    typename Space::template FieldOf<3> qd, base_position, base_velocity;

    JointCoordinates() = default;
    explicit JointCoordinates(ChainGroup const& group)
        : q(group.size),
          qd(group.size),
          base_position(std::ssize(group.pieces)),
          base_velocity(std::ssize(group.pieces)) {}
    StateView view() { return {q.view(), qd.view(), base_position.view(), base_velocity.view()}; }
};
using JointState = JointCoordinates<HostSpace>;
/// State at the scene's start (time 0). Joints with prescribed motion start on their course.
JointState make_joint_state(ChainGroup const&, Scene const&);

/// Storage behind MotionView: the motion of bodies.
template <class Space>
struct MotionFields {
    typename Space::template FieldOf<4> joint_turn, orientation;
    typename Space::template FieldOf<3> omega, origin, velocity, r2;
    typename Space::template FieldOf<6> axes2;

    MotionFields() = default;
    /// Handle 2 of bodies (r2, axes2) is stored only for groups in which it depends on the joint
    /// coordinates.
    MotionFields(ChainGroup const& group, Space const& space)
        : joint_turn(group.size),
          orientation(group.size),
          omega(group.size),
          origin(group.size),
          velocity(group.size) {
        if (!group.joints.moving_meeting()) return;
        r2 = typename Space::template FieldOf<3>(group.size);
        axes2 = typename Space::template FieldOf<6>(group.size);
        fill(space, r2, group.bodies.r2);
        fill(space, axes2, group.bodies.axes2);
    }
    MotionView view() {
        return {joint_turn.view(), orientation.view(), omega.view(), origin.view(),
                velocity.view(),   r2.view(),          axes2.view()};
    }
};
using BodyMotion = MotionFields<HostSpace>;

/// Computes the motion of every body from the state. Chains that span several ranks make its
/// operations collective: all ranks must call them.
template <class Space>
class JointKinematics {
  public:
    /// Messages to the inboard neighbour about this rank's first body, sent together with the
    /// exchange of motions; either may be empty. LoadsForNeighbour holds the loads of its inboard
    /// joint (RevoluteLoads). MeetingForNeighbour holds that joint's meeting point and axes on the
    /// body before.
    using LoadsForNeighbour = BodyExchange<4>;
    using MeetingForNeighbour = BodyExchange<9>;
    /// The group and the communicator must outlive this object.
    JointKinematics(ChainGroup const& group, Space const& space, Communicator const& communicator)
        : group_(group),
          space_(space),
          alone_(alone(space)),
          communicator_(communicator),
          joints_(group, space),
          arrays_(group),
          trees_(group.schedule),
          shared_(group.schedule, dca::RecordNumbers<Motion>::width, space, communicator,
                  MeetingForNeighbour::numbers + LoadsForNeighbour::numbers) {
        begin_at_ground();
    }

    JointsIn<Space> const& joints() const { return joints_; }
    /// Rotation of each body relative to its inboard body, as a scan leaves it
    /// (JointScan::rotation).
    ConstView<4> rotations() { return arrays_.rotation(); }
    /// The scan that reads `state` and writes `motion`.
    JointScan scan(StateView const& state, MotionView const& motion) {
        return arrays_.scan(joints_.view(), state, motion);
    }

    /// Computes the motion of all bodies. `with_positions`: fills origin and velocity as well.
    /// Collective if ranks share a chain.
    void evaluate(StateView const& state, bool with_positions, MotionView const& motion) {
        with_positions ? evaluate<true>(scan(state, motion)) : evaluate<false>(scan(state, motion));
    }
    /// Runs the inward and the outward pass of the scan, then last(k) for every body, which must
    /// include set_motion(). Precondition: set_relative() of every body. Collective if ranks share
    /// a chain.
    template <bool positions, class Last>
    void sweep(JointScan const& s, LoadsForNeighbour const& loads, Last const& last) {
        if (goes_by_levels()) return by_levels(last);
        sweep<positions>(s, loads);
        space_.for_each(group_.size, last);
    }
    /// True if the chains are branched. Their bodies are then visited level by level, each after
    /// its inboard body.
    bool goes_by_levels() const { return joints_.levels().levels() > 0; }
    /// Overload without an action per body.
    template <bool positions>
    void sweep(JointScan const& s, LoadsForNeighbour const& loads) {
        sweep<positions>(s, trees_.own(), loads);
    }
    /// Overload over another tree: `tree` is the group's tree less the runs that JointScan::follow
    /// has already finished.
    template <bool positions>
    void sweep(JointScan const& s, typename Space::ScanTree const& tree,
               LoadsForNeighbour const& loads) {
        sweep_with(MotionScan<positions>{s}, tree, loads);
    }

    /// Sweep with a scan that may do more per run than MotionScan, such as computing the joints'
    /// loads. These are then sent to the inboard neighbour as `loads`.
    template <class Scan>
    void sweep_with(Scan const& scan, typename Space::ScanTree const& tree,
                    LoadsForNeighbour const& loads) {
        if (group_.schedule.shared.empty()) return space_.climb_and_descend(tree, scan);
        MeetingForNeighbour const meeting = shown_meeting(scan.motions().s);
        pass(scan, tree, meeting, loads);
    }
    /// Runs `scan` over all runs, then last(run) for each run.
    template <class Scan, class Last>
    void sweep_runs(Scan const& scan, LoadsForNeighbour const& loads, Last const& last) {
        sweep_with(scan, trees_.own(), loads);
        space_.over(trees_.runs(), last);
    }

    // Members below are public because nvcc accepts device lambdas in public members only.
    /// Calls last(k) for the bodies of each level, level after level.
    template <class Last>
    void by_levels(Last const& last) {
        std::vector<std::int64_t> const& first = joints_.levels().first_of_level;
        for (std::size_t level = 0; level + 1 < first.size(); ++level) {
            std::int64_t const* const body = joints_.body_of_level().data() + first[level];
            std::int64_t const count = first[level + 1] - first[level];
            Space const& space = count < dca::level_worth_threads ? alone_ : space_;
            space.for_each(count, [body, last] CATENA_LAMBDA(std::int64_t i) { last(body[i]); });
        }
    }
    template <bool positions>
    void evaluate(JointScan const& s) {
        space_.for_each(group_.size, [s] CATENA_LAMBDA(std::int64_t k) {
            s.template set_relative<positions>(k);
        });
        sweep<positions>(s, LoadsForNeighbour::none(), [s] CATENA_LAMBDA(std::int64_t k) {
            s.template set_motion<positions>(k);
        });
    }
    /// Prepares the message with the meeting point and axes of this rank's first joint. The message
    /// is empty unless meeting frames move and a neighbour shares the chain.
    MeetingForNeighbour shown_meeting(JointScan const& s) {
        View<9> const meeting = arrays_.next_meeting();
        MeetingForNeighbour const shown{meeting, 0, group_.neighbours.inboard,
                                        meeting, 1, group_.neighbours.outboard};
        if (!group_.joints.moving_meeting() || !shown) return MeetingForNeighbour::none();
        space_.for_each(1, [s] CATENA_LAMBDA(std::int64_t) { s.show_first_meeting(); });
        return shown;
    }
    /// Sets the motion before each chain's first body to rest relative to the ground.
    void begin_at_ground() {
        MotionRecords const before = arrays_.before();
        space_.over(trees_.roots(), [before] CATENA_LAMBDA(dca::Root const& root) {
            before.store(root.slot, Motion::none());
        });
        space_.over(trees_.top_roots(), [before] CATENA_LAMBDA(dca::Root const& root) {
            before.store(root.slot, Motion::none());
        });
    }

  private:
    /// Returns a space without threads, where that is another one.
    static Space alone(Space const& space) {
        if constexpr (std::is_same_v<Space, HostSpace>)
            return HostSpace(this_thread());
        else
            return space;
    }
    /// Motions of this rank's units, as the frontier exchange between ranks reads and writes them.
    template <class Scan>
    dca::RecordNumbers<Motion> shown(Scan const& scan) {
        return {scan.motions().s.whole, shared_.own_units(), shared_.units()};
    }
    /// Implements sweep_with() for chains that ranks share. The exchange runs with the scan in one
    /// launch if the Space can do so; otherwise inward pass, exchange, tree above the units,
    /// outward pass.
    template <class Scan>
    void pass(Scan const& scan, typename Space::ScanTree const& tree,
              MeetingForNeighbour const& meeting, LoadsForNeighbour const& loads) {
        if (shared_.both_passes(space_, communicator_, shown(scan), tree, trees_.top(), scan,
                                meeting, loads))
            return;
        space_.climb(tree, scan);
        shared_.show(space_, shown(scan));
        shared_.bring(space_, communicator_, shown(scan), meeting, loads);
        space_.climb_and_descend(trees_.top(), scan.motions());
        space_.descend(tree, scan);
    }

    ChainGroup const& group_;
    Space space_, alone_;
    Communicator const& communicator_;
    JointsIn<Space> joints_;
    ScanArrays<Space> arrays_;
    ScanTrees<Space> trees_;
    dca::FrontierExchange<Space> shared_;
};

}  // namespace catena
