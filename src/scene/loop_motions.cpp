// Implements the counts of a loop: twists of all joints in one frame, closed under Lie brackets.
#include "scene/loop_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "joints/joint_models.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

namespace {

/// Fraction of a unit twist that counts as zero: numbers printed with seven digits.
double constexpr printed_digits = 1e-6;

double dot(Twist const& a, Twist const& b) {
    return catena::dot(a.angular, b.angular) + catena::dot(a.linear, b.linear);
}
Twist plus_scaled(Twist const& a, double factor, Twist const& b) {
    return {a.angular + factor * b.angular, a.linear + factor * b.linear};
}
/// Lie bracket: the motion that two motions make where each follows the other in turn.
Twist bracket(Twist const& a, Twist const& b) {
    return {cross(a.angular, b.angular), cross(a.angular, b.linear) + cross(a.linear, b.angular)};
}

/// Space of twists in one frame, lengths in units of the chain's.
class TwistSpace {
  public:
    int dimension() const { return dimension_; }
    bool is_full() const { return dimension_ == 6; }
    /// Adds a twist; returns true if it was not in the space.
    bool add(Twist const& twist) {
        double const size = std::sqrt(dot(twist, twist));
        return size > 0 && add_part({(1 / size) * twist.angular, (1 / size) * twist.linear});
    }
    /// Adds what the motions make together: the space is then that of a group.
    void close() {
        for (int i = 1; i < dimension_; ++i)
            for (int j = 0; j < i; ++j) add_part(bracket(basis(i), basis(j)));
    }

  private:
    Twist const& basis(int i) const { return basis_[static_cast<std::size_t>(i)]; }
    /// Adds a twist's part across the space if it exceeds `printed_digits`.
    bool add_part(Twist part) {
        for (int again = 0; again < 2; ++again)
            for (int i = 0; i < dimension_; ++i)
                part = plus_scaled(part, -dot(basis(i), part), basis(i));
        double const size = std::sqrt(dot(part, part));
        if (is_full() || !(size > printed_digits)) return false;
        basis_[static_cast<std::size_t>(dimension_++)] = {(1 / size) * part.angular,
                                                          (1 / size) * part.linear};
        return true;
    }

    std::array<Twist, 6> basis_;
    int dimension_ = 0;
};

/// Longest distance between consecutive joints, or 1.
double length_of(ChainSpec const& chain) {
    double longest = norm(chain.tip_joint.translation);
    for (Vec3 const& r : chain.bodies.translation) longest = std::max(longest, norm(r));
    return longest > 0 ? longest : 1;
}

/// Adds the twists of a joint with frame J at `frame`; returns true if one of them is new.
bool add_joint(JointType type, JointShape const& shape, std::array<double, 4> const& q,
               Pose const& frame, double length, TwistSpace& space) {
    Mat3 const axes = to_matrix(frame.orientation);
    bool any = false;
    with_joint(type, [&](auto model) {
        for (Twist const& t : decltype(model)::twists(shape, q)) {
            Vec3 const angular = axes * t.angular;
            Vec3 const linear = axes * t.linear + cross(frame.origin, angular);
            any |= space.add({angular, (1 / length) * linear});
        }
        return any;
    });
    return any;
}

/// Returns the motions of the last body that the joints make, W. In a ring they are relative to the
/// first body, in its axes; its own joint is not part of the loop. `end` receives the last body's
/// pose, unless the space is full before it.
TwistSpace motions_of_bodies(ChainSpec const& chain, double length, Pose& end) {
    BodyArrays const& bodies = chain.bodies;
    TwistSpace space;
    for (std::size_t k = chain.is_ring() ? 1 : 0; k < bodies.size(); ++k) {
        Pose const frame{to_quaternion(bodies.rotation[k]), bodies.translation[k]};
        JointShape const shape{bodies.axis[k],
                               bodies.first_axis.empty() ? Vec3::zero() : bodies.first_axis[k],
                               bodies.pitch.empty() ? 0 : bodies.pitch[k]};
        if (add_joint(bodies.joint[k], shape, bodies.q[k], end * frame, length, space))
            space.close();
        if (space.is_full()) return space;
        end = next_pose(bodies, k, end);
    }
    return space;
}

}  // namespace

int restricted_by_tip(ChainSpec const& chain) {
    TipJoint const& tip = chain.tip_joint;
    double const length = length_of(chain);
    Pose end;
    TwistSpace space = motions_of_bodies(chain, length, end);
    Pose const frame = end * Pose{to_quaternion(tip.rotation), tip.translation};
    add_joint(tip.type, {tip.axis, tip.first_axis, tip.pitch}, tip.q, frame, length, space);
    return space.dimension() - freedom_of(tip.type);
}

}  // namespace catena::scene
