// Loops of the chains of a group at their current motion, on the host. Chains with loops are
// computed there.
#pragma once

#include <vector>

#include "dynamics/joint/jointed_tips.hpp"

namespace catena {

/// The joints that close the loops of a rank's chains, with what the solver needs of each. Both
/// sides are treated as those of a jointed tip: J in the inboard body, G in the outboard one.
class ClosedLoops {
  public:
    /// `reach`: characteristic length (reach_of()). The group must outlive this object.
    ClosedLoops(ChainGroup const& group, double reach);

    bool any() const { return !joints_.empty(); }
    /// Sets ends() from the motion of all bodies, positions included.
    void set_ends(MotionView const&);
    /// Sets bias() for accelerations: velocity terms, and gravity as an acceleration of the ground.
    void set_acceleration_bias(Vec3 const& gravity);
    /// Sets bias() for a correction: the openings along the joints' directions or, if `velocities`,
    /// their rates.
    void set_opening(bool velocities);
    /// Throws ComputationError that names the first loop whose two sides still part after a
    /// correction of velocities, given the response to set_opening(). Only driven joints can cause
    /// that.
    void refuse_parting(ConstView<3> const& alpha, ConstView<3> const& acceleration) const;
    /// Largest opening along a restricted direction; lengths are divided by the reach, angles are
    /// in rad.
    double error() const;

    /// ConfigurationView::loop_ends, LoadsView::loop_bias and AccelerationsView::loop_force.
    std::vector<LoopEnds> const& ends() const { return ends_; }
    std::vector<Vector<double, 6>> const& bias() const { return bias_; }
    std::vector<Vector<double, 6>>& force() { return force_; }
    std::vector<Vector<double, 6>> const& force() const { return force_; }
    /// Adds the forces of the joints to the loads of bodies, B.
    void add_forces(Field<3>& torque, Field<3>& force) const;

  private:
    JointedTips::Ends motions_of(std::size_t loop, MotionView const&) const;

    ChainGroup const& group_;
    double reach_;
    /// The joints as those of tips, and the orientations of G in the outboard bodies.
    std::vector<JointedTip> joints_;
    std::vector<Quat> end_rotation_;
    /// Motions and places of both sides at the last set_ends().
    std::vector<JointedTips::Ends> motions_;
    std::vector<JointedTips::Place> places_;
    std::vector<LoopEnds> ends_;
    std::vector<Vector<double, 6>> bias_, force_;
};

}  // namespace catena
