// The joints between last bodies and the ground, for chains in joint coordinates: where they are, what their velocities add, and
// how far they have come open.
#pragma once

#include <vector>

#include "chain/joint_kinematics.hpp"
#include "dca/leaf.hpp"
#include "dca/solver.hpp"

namespace catena {

using dca::Screw;

class JointedTips {
  public:
    /// `start`: motion at the scene's start, positions included, which decides where the ground's frames are. `reach`: a length that
    /// openings are measured by.
    JointedTips(ChainGroup const&, BodyMotion const& start, double reach);

    /// Handles 2 of last bodies, where meetings move (BodyMotion::r2, axes2).
    void set_meetings(BodyMotion&) const;
    /// LoadsView::tip_bias for the accelerations: velocity terms, and gravity as the ground's acceleration.
    void set_acceleration_bias(BodyMotion const&, Vec3 const& gravity, DirectionsView) const;
    /// The same for corrections: how far the joints are open, or how fast they come open, along their directions.
    void set_opening(BodyMotion const&, bool velocities, DirectionsView) const;
    /// Largest opening over the reach (angles count by it already).
    double error(BodyMotion const&) const;

  private:
    struct Tip {
        LocalTip const* local = nullptr;
        Quat ground_rotation;  // of G in W
        Vec3 ground_origin;    // W
        Vec3 com;              // of the last body from its origin, B
        double cosine = 0;     // universal: of the angle between its axes
    };
    struct Meeting {
        Vec3 point;  // from the centre of mass, B
        Mat3 axes;   // B
    };
    /// Angular and linear parts along a meeting's axes.
    struct Pair {
        Vec3 angular, linear;
    };
    Meeting meeting(Tip const&, BodyMotion const&) const;
    Pair velocity_terms(Tip const&, Meeting const&, BodyMotion const&) const;
    Pair opening(Tip const&, Meeting const&, BodyMotion const&) const;
    Pair opening_rate(Tip const&, Meeting const&, BodyMotion const&) const;
    Vector<double, 6> along_directions(Tip const&, Pair const&) const;
    void store(DirectionsView, std::int64_t body, Vector<double, 6> const&) const;

    ChainGroup const& group_;
    double reach_;
    std::vector<Tip> tips_;
};

}  // namespace catena
