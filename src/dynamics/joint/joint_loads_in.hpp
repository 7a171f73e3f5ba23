// Loads of a group's bodies in joint coordinates in any Space, and what is known of them.
#pragma once

#include <algorithm>

#include "dynamics/joint/joint_chains.hpp"

namespace catena {

/// Pending part of the loads of the last updated configuration.
enum class LoadsLeft : std::uint8_t {
    nothing,
    beads,    // Loads of all bodies; they wait for the forces on carried beads.
    loads,    // What the solver can compute itself (LeftToSolver).
    motions,  // In addition, the motion within runs.
};

/// Revolute joints that the solver eliminates within runs, in a Space.
template <class Space>
class EliminatedJoints {
  public:
    EliminatedJoints(ChainGroup const& group, bool eliminates)
        : eliminates_(eliminates), codes_(eliminates ? codes_of(group) : none()), list_(codes_) {}

    /// True if the solver eliminates_revolute_joints().
    explicit operator bool() const { return eliminates_; }
    RevolutesInRuns view() const { return {list_.data()}; }

  private:
    static std::vector<std::uint8_t> none() { return {}; }
    /// Codes of RevolutesInRuns for all bodies.
    static std::vector<std::uint8_t> codes_of(ChainGroup const& group) {
        std::vector<std::uint8_t> in_run(static_cast<std::size_t>(group.size), 0);
        for (dca::Run const& run : group.schedule.runs)
            for (std::int64_t k = run.body; run.count > 1 && k < run.body + run.count; ++k)
                if (group.ends.is_first[static_cast<std::size_t>(k)] == 0)
                    in_run[static_cast<std::size_t>(k)] =
                        k == run.body ? RevolutesInRuns::first : RevolutesInRuns::within;
        return in_run;
    }

    bool eliminates_;
    std::vector<std::uint8_t> codes_;
    typename Space::template List<std::uint8_t> list_;
};

/// Implicit joint springs and dampers in a Space (ImplicitJoints).
template <class Space>
class ImplicitJointsIn {
  public:
    /// `step`: step length h. `rotor`: rotor_of_spring() of the integrator.
    ImplicitJointsIn(ChainGroup const& group, double rotor, double step)
        : any_(!group.joints.implicit.empty()),
          of_stiffness_(rotor * step * step),
          of_damping_(0.5 * step),
          list_(group.joints.implicit),
          compliance_(any_ ? group.size : 0),
          yielding_(any_ ? group.size : 0) {}

    explicit operator bool() const { return any_; }
    /// `start`: velocities at the step's start. Precondition: there are implicit joints.
    ImplicitJoints view(View<3> const& start) {
        return {of_stiffness_,      of_damping_,      list_.data(),
                compliance_.view(), yielding_.view(), start};
    }
    typename Space::template FieldOf<6>& compliance() { return compliance_; }

  private:
    bool any_;
    double of_stiffness_, of_damping_;
    typename Space::template List<std::uint8_t> list_;
    typename Space::template FieldOf<6> compliance_;
    typename Space::template FieldOf<3> yielding_;
};

/// Given loads, the arrays of the resulting loads, and their phase.
template <class Space>
struct JointLoadsIn {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;

    JointLoadsIn(ChainGroup const& group, BodyLoads const& loads, Space const& space,
                 bool eliminates, double rotor, double implicit_step)
        : given(loads),
          in_space(loads),
          has_wrenches(loads.wrenches || group.carried.count() > 0),
          has_forces(has_wrenches || loads.act_on_bodies() ||
                     (loads.joint_loads && group.joints.has_screws) || group.loops.in_scene),
          carried(group.carried.in_scene),
          eliminated(group, eliminates),
          implicit(group, rotor, implicit_step),
          beads(group, space),
          joint_load(loads.joint_loads ? group.size : 0),
          torque(group.size),
          force(has_forces ? group.size : 0),
          bias(group.size + 1, group.directions) {}

    /// True if the solver computes loads itself.
    bool leaves_loads() const { return left >= LoadsLeft::loads; }
    /// True if the solver computes the motion within runs itself.
    bool leaves_motions() const { return left == LoadsLeft::motions; }
    /// True if the gyroscopic torque is the only torque on bodies, on any rank, so that the solver
    /// can compute it.
    bool leaves_torques() const {
        return leaves_loads() && !given.joint_loads && !given.act_on_bodies() && !carried;
    }
    /// Notes that the loads are known but for those that wait for forces on beads.
    void leave_beads() { left = carried ? LoadsLeft::beads : LoadsLeft::nothing; }
    /// Notes that the motion within runs is known.
    void found_motions() { left = std::min(left, LoadsLeft::loads); }
    /// Message with the joint loads of this rank's first body, to the inboard neighbour.
    BodyExchange<4> shown(ChainGroup const& group) {
        return given.joint_loads ? from_outboard(group, joint_load.view())
                                 : BodyExchange<4>::none();
    }
    /// Sets the views of the bodies and their loads.
    void show(JointLoads& c, JointsIn<Space> const& joints) {
        c.mass = joints.model().mass();
        c.inertia = joints.model().inertia();
        c.moved.fixed_r2 = joints.bodies().r2;
        c.moved.fixed_axes2 = joints.bodies().axes2;
        c.given = in_space.view();
        c.has_wrenches = has_wrenches;
        c.has_forces = has_forces;
        c.beads = beads.view();
        c.joint_load = joint_load.view();
        c.torque = torque.view();
        c.force = force.view();
        c.bias = bias.view();
        c.in_run = eliminated.view();
    }
    /// Loads from which the solver computes torques within runs itself.
    RevoluteLoads of_revolutes(ConstView<4> const& rotation, ConstView<4> const& orientation) {
        RevoluteLoads all{true, rotation, {}, {}, {}, {}, {}};
        View<4> const joint = joint_load.view();
        if (given.joint_loads) all.joint_torque = {joint.origin, joint.pitch, joint.size};
        if (given.wrenches) {
            BodyLoadsView const of_bodies = in_space.view();
            all.torque = of_bodies.wrench_torque;
            all.force = of_bodies.wrench_force;
            all.orientation = orientation;
        }
        return all;
    }

    BodyLoads const& given;
    BodyLoadsIn<Space> in_space;
    bool has_wrenches, has_forces;
    /// True if any rank's part of the group carries beads.
    bool carried;
    LoadsLeft left = LoadsLeft::nothing;
    EliminatedJoints<Space> eliminated;
    ImplicitJointsIn<Space> implicit;
    CarriedBeadsIn<Space> beads;
    FieldOf<4> joint_load;
    FieldOf<3> torque, force;
    typename Space::Directions bias;
};

}  // namespace catena
