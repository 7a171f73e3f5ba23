// Implements the counts of degrees of freedom and the choice of the kind of handle.
#include "scene/freedom.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "joints/joint_models.hpp"
#include "scene/loop_motions.hpp"
#include "scene/loops.hpp"

namespace catena::scene {

namespace {

/// Tolerance for numbers printed with seven digits.
double constexpr printed_digits = 1e-6;
/// Rounding error of a few products of rotations.
double constexpr rounding = 32 * std::numeric_limits<double>::epsilon();

/// Follows one axis along the chain, in the axes of the body that was added last.
class ParallelAxes {
  public:
    explicit ParallelAxes(double tolerance) : tolerance_(tolerance) {}
    /// True if the joint keeps all axes so far parallel. `rotation` is that of J in the inboard
    /// body.
    bool add(JointType type, Vec3 const& axis, Mat3 const& rotation) {
        PlaneRole const role = role_in_plane(type);
        if (role == PlaneRole::starts) return !any_;
        if (role == PlaneRole::carries) {
            axis_ = transposed_times(rotation, axis_);
            return true;
        }
        if (role != PlaneRole::turns) return false;
        bool const parallel = !any_ || norm(cross(rotation * axis, axis_)) <= tolerance_;
        axis_ = axis;
        any_ = true;
        return parallel;
    }
    bool any() const { return any_; }
    /// Direction of the common axis. Precondition: any().
    Vec3 const& direction() const { return axis_; }

  private:
    double tolerance_;
    Vec3 axis_ = Vec3::zero();
    bool any_ = false;
};

/// Returns false at the first joint, the tip excluded, that breaks the parallelism.
bool add_all(BodyArrays const& bodies, ParallelAxes& axes, std::size_t& first_odd) {
    for (first_odd = 0; first_odd < bodies.size(); ++first_odd)
        if (!axes.add(bodies.joint[first_odd], bodies.axis[first_odd], bodies.rotation[first_odd]))
            return false;
    return true;
}

/// Implements axes_are_parallel() with a given tolerance on the sine of the angle.
bool parallel_within(double tolerance, ChainSpec const& chain, std::size_t& first_odd) {
    ParallelAxes axes(tolerance);
    if (!add_all(chain.bodies, axes, first_odd)) return false;
    bool const pinned =
        chain.tip == Tip::jointed && is_ball(chain.tip_joint.type);  // rotates about any axis
    if (chain.tip == Tip::jointed && !pinned &&
        !axes.add(chain.tip_joint.type, chain.tip_joint.axis, chain.tip_joint.rotation))
        return false;
    return axes.any();
}

/// True if some joint translates, the tip's included.
bool any_slides(ChainSpec const& chain) {
    return std::any_of(chain.bodies.joint.begin(), chain.bodies.joint.end(), slides) ||
           (chain.tip == Tip::jointed && slides(chain.tip_joint.type));
}

/// True for an unbranched chain of revolute joints from the ground on, without loops, that rotates
/// about one axis, in one plane. Loops need forces along all directions. The tolerance is rounding,
/// because planar handles omit all motion out of the plane.
bool is_planar(ChainSpec const& chain) {
    std::size_t odd = 0;
    return chain.base == Base::fixed && !chain.is_branched() && !chain.has_loops() &&
           !any_slides(chain) && parallel_within(rounding, chain, odd);
}

std::int64_t freedom_of_links(ChainSpec const& chain) {
    auto const n = static_cast<std::int64_t>(chain.size());
    std::int64_t dof = 3 * n - (chain.base == Base::free ? n - 1 : n);
    for (std::size_t k = 0; k < chain.linked.size(); ++k) dof += chain.linked.is_bead(k) ? 0 : 3;
    dof -= std::ssize(chain.crosslinks) - chain.redundant_links;
    return dof - (chain.tip == Tip::free ? 0 : 1);
}

}  // namespace

int coordinates_of(JointType type) { return freedom_of(type); }

bool resists(BodyArrays const& bodies, std::size_t body) {
    auto const any = [&](std::vector<Vec3> const& v) {
        return !v.empty() && (v[body][0] != 0 || v[body][1] != 0 || v[body][2] != 0);
    };
    return any(bodies.stiffness) || any(bodies.damping);
}
bool resists(ChainSpec const& chain) {
    for (std::size_t body = 0; body < chain.bodies.size(); ++body)
        if (resists(chain.bodies, body)) return true;
    return false;
}

ImplicitInertias implicit_inertias(BodyArrays const& bodies, std::size_t body,
                                   DynamicsSpec const& dynamics) {
    ImplicitInertias found{HUGE_VAL, 0};
    for (int i = 0; i < coordinates_of(bodies.joint[body]); ++i) {
        double const stiffness = bodies.stiffness.empty() ? 0 : bodies.stiffness[body][i];
        double const damping = bodies.damping.empty() ? 0 : bodies.damping[body][i];
        double const inertia =
            dynamics.step *
            (0.5 * damping + rotor_of_spring(dynamics.integrator) * dynamics.step * stiffness);
        found.least = std::min(found.least, inertia), found.most = std::max(found.most, inertia);
    }
    return found;
}

bool axes_are_parallel(ChainSpec const& chain, std::size_t& first_odd) {
    return parallel_within(printed_digits, chain, first_odd);
}

HandleKind handle_kind(ChainSpec const& chain) {
    if (chain.is_beads() || chain.is_linked()) return HandleKind::link;
    BodyArrays const& bodies = chain.bodies;
    int least = 3;  // coordinates of the most restricting joint
    for (JointType const joint : bodies.joint) least = std::min(least, coordinates_of(joint));
    if (chain.tip == Tip::jointed) least = std::min(least, coordinates_of(chain.tip_joint.type));
    if (!bodies.driven.empty() || least == 0) return HandleKind::full;
    if (least == 1 || any_slides(chain))
        return is_planar(chain) ? HandleKind::planar : HandleKind::revolute;
    return least == 2 ? HandleKind::universal : HandleKind::spherical;
}

int directions_of(HandleKind kind) { return 1 + static_cast<int>(kind); }

char const* name_of(HandleKind kind) {
    static constexpr char const* names[] = {"link",      "planar",   "spherical",
                                            "universal", "revolute", "full"};
    return names[static_cast<int>(kind)];
}

bool takes_articulated_handles(ChainSpec const& chain) {
    return chain.bodies.size() > 0 && chain.tip == Tip::free;
}

std::int64_t degrees_of_freedom(ChainSpec const& chain) {
    if (chain.is_beads() || chain.is_linked()) return freedom_of_links(chain);
    BodyArrays const& bodies = chain.bodies;
    std::int64_t dof = chain.tip == Tip::free ? 0 : -restricted_by_tip(chain);
    dof -= directions_of_loops(chain) - chain.redundant_directions;
    for (JointType const joint : bodies.joint) dof += coordinates_of(joint);
    for (DrivenJoint const& driven : bodies.driven)
        dof -= coordinates_of(bodies.joint[static_cast<std::size_t>(driven.body)]);
    return dof;
}

std::optional<std::pair<std::size_t, JointType>> joint_without_absolute_coordinates(
    ChainSpec const& chain) {
    auto const& joints = chain.bodies.joint;
    auto const found = std::find_if_not(joints.begin(), joints.end(), is_absolute);
    if (found != joints.end())
        return std::pair{static_cast<std::size_t>(found - joints.begin()), *found};
    if (chain.tip == Tip::jointed && !is_absolute(chain.tip_joint.type))
        return std::pair{joints.size(), chain.tip_joint.type};
    return std::nullopt;
}

}  // namespace catena::scene
