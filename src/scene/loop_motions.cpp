// Implements the counts of a loop: twists of all joints in one frame, closed under Lie brackets.
#include "scene/loop_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "joints/joint_models.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

namespace {

/// Fraction of a unit twist that counts as zero: numbers printed with seven digits.
double constexpr negligible_twist = 1e-6;
/// Most bodies of a loop that is cut at every pair of joints, a cost of n^3.
std::size_t constexpr longest_cut_everywhere = 32;

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
    Twist const& basis(int i) const { return basis_[static_cast<std::size_t>(i)]; }
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
    /// Adds a twist's part across the space if it exceeds `negligible_twist`.
    bool add_part(Twist part) {
        for (int again = 0; again < 2; ++again)
            for (int i = 0; i < dimension_; ++i)
                part = plus_scaled(part, -dot(basis(i), part), basis(i));
        double const size = std::sqrt(dot(part, part));
        if (is_full() || !(size > negligible_twist)) return false;
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

/// Twists of a joint.
struct LoopJoint {
    std::array<Twist, 6> twists;
    std::size_t count = 0;
};

/// Returns the twists of a joint with frame J at `frame`, in the axes and about the origin of the
/// frame's reference, lengths divided by `length`.
LoopJoint joint_at(JointType type, JointShape const& shape, std::array<double, 4> const& q,
                   Pose const& frame, double length) {
    Mat3 const axes = to_matrix(frame.orientation);
    LoopJoint joint;
    with_joint(type, [&](auto model) {
        for (Twist const& t : decltype(model)::twists(shape, q)) {
            Vec3 const angular = axes * t.angular,
                       linear = axes * t.linear + cross(frame.origin, angular);
            joint.twists[joint.count++] = {angular, (1 / length) * linear};
        }
        return true;
    });
    return joint;
}

/// Adds a joint's twists; returns true if one of them is new.
bool add(TwistSpace& space, LoopJoint const& joint) {
    bool any = false;
    for (std::size_t i = 0; i < joint.count; ++i) any |= space.add(joint.twists[i]);
    return any;
}

/// Calls visit(joint) for the bodies' joints of the loop, then for the tip's, until it returns
/// false. Twists are in W or, in a ring, in the axes of the first body, whose own joint is not part
/// of the loop.
template <class Visit>
void visit_joints(ChainSpec const& chain, Visit const& visit) {
    BodyArrays const& bodies = chain.bodies;
    double const length = length_of(chain);
    Pose end;
    for (std::size_t k = chain.is_ring() ? 1 : 0; k < bodies.size(); ++k) {
        Pose const frame{to_quaternion(bodies.rotation[k]), bodies.translation[k]};
        JointShape const shape{bodies.axis[k],
                               bodies.first_axis.empty() ? Vec3::zero() : bodies.first_axis[k],
                               bodies.pitch.empty() ? 0 : bodies.pitch[k]};
        if (!visit(joint_at(bodies.joint[k], shape, bodies.q[k], end * frame, length))) return;
        end = next_pose(bodies, k, end);
    }
    TipJoint const& tip = chain.tip_joint;
    Pose const frame{to_quaternion(tip.rotation), tip.translation};
    visit(joint_at(tip.type, {tip.axis, tip.first_axis, tip.pitch}, tip.q, end * frame, length));
}

/// Motions of the joints of a part of a loop: of one joint its own, of several those of their
/// group.
class PartOfLoop {
  public:
    void add(LoopJoint const& joint) {
        if (scene::add(space_, joint) && joints_ > 0) space_.close();
        ++joints_;
    }
    TwistSpace const& motions() const { return space_; }

  private:
    TwistSpace space_;
    int joints_ = 0;
};

/// Number of directions of the motions of two parts of a loop together.
int directions_of(TwistSpace a, TwistSpace const& b) {
    for (int i = 0; i < b.dimension(); ++i) a.add(b.basis(i));
    return a.dimension();
}

/// Returns the least number of directions over all ways to cut a loop into two parts. The motions
/// of either part do not depend on the position of the other, so this holds at all positions.
int least_directions(std::vector<LoopJoint> const& joints) {
    std::size_t const n = joints.size();
    int least = 6;
    for (std::size_t begin = 0; begin + 1 < n; ++begin) {
        PartOfLoop part;
        for (std::size_t end = begin + 1; end < n && !part.motions().is_full(); ++end) {
            part.add(joints[end - 1]);
            PartOfLoop rest;
            for (std::size_t k = end; k < n + begin && !rest.motions().is_full(); ++k)
                rest.add(joints[k % n]);
            least = std::min(least, directions_of(part.motions(), rest.motions()));
        }
    }
    return least;
}

/// Returns the number of directions of a loop that is cut at its tip only.
int directions_at_tip(ChainSpec const& chain) {
    PartOfLoop bodies;
    LoopJoint tip;
    std::size_t left = chain.bodies.size() - (chain.is_ring() ? 1 : 0);
    visit_joints(chain, [&](LoopJoint const& joint) {
        if (left-- == 0)
            tip = joint;
        else
            bodies.add(joint);
        return !bodies.motions().is_full();
    });
    TwistSpace all = bodies.motions();
    add(all, tip);
    return all.dimension();
}

}  // namespace

int restricted_by_tip(ChainSpec const& chain) {
    int const own = freedom_of(chain.tip_joint.type);
    if (chain.bodies.size() > longest_cut_everywhere) return directions_at_tip(chain) - own;
    std::vector<LoopJoint> joints;
    visit_joints(chain, [&](LoopJoint const& joint) {
        joints.push_back(joint);
        return true;
    });
    return least_directions(joints) - own;
}

}  // namespace catena::scene
